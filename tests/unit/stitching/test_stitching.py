"""One motion out of several clips: what is changed, what is not, and what it is good for."""

import numpy as np
import pytest

from stridewire._messages import RootPath, StitchHeader, StitchQuery
from stridewire_engine.library import Library
from stridewire_engine.stitching import Stitching
from stridewire_engine.stitching.alignment import lay
from stridewire_engine.stitching.chains import chains_after
from stridewire_engine.stitching.cuts import best_cuts
from unit.stitching.clips import cuts_of, stitched

PLAIN = ["spring", "quintic", "dead-blend", "stance"]
WINDOW = 90


def test_the_root_goes_on_where_and_as_fast_as_it_was(small_library: Library) -> None:
    """Neither place nor velocity of the root jumps at a seam more than within the clips."""
    clips = cuts_of(small_library)
    plan = lay(clips)
    velocity = np.diff(plan.root_position, axis=0) * 60.0
    change = np.linalg.norm(np.diff(velocity, axis=0), axis=-1)
    turning = np.abs(np.diff(plan.root_yaw, n=2)) * 60.0
    inside = np.ones(len(change), bool)
    inside[np.concatenate([plan.seams - 2, plan.seams - 1])] = False
    assert change[~inside].max() < 2.0 * change[inside].max()
    assert turning[~inside].max() < 2.0 * turning[inside].max()


def test_a_clip_keeps_its_path_but_for_a_third_of_a_second(small_library: Library) -> None:
    """From there on its root moves just as in the clip, wherever it was set."""
    clips = cuts_of(small_library)
    plan, last = lay(clips), clips[-1].pose.root_position.astype(np.float64)
    way = np.linalg.norm(np.diff(plan.root_position[-100:], axis=0), axis=-1)
    np.testing.assert_allclose(
        way, np.linalg.norm(np.diff(last[-100:], axis=0), axis=-1), atol=1e-6
    )


@pytest.mark.parametrize("stitcher", [*PLAIN, "auto"])
def test_far_from_seams_clips_pass_bit_by_bit(small_library: Library, stitcher: str) -> None:
    """Hips and rotations outside of the windows are the clips' own numbers."""
    clips = cuts_of(small_library)
    made, pose, report = stitched(clips, stitcher=stitcher)
    rotations = np.concatenate([c.pose.rotations for c in clips])
    hips = np.concatenate([c.pose.hips for c in clips])
    frames = np.arange(len(pose.hips))
    near = np.any([(frames >= s) & (frames < s + WINDOW) for s in made.plan.seams], axis=0)
    assert np.array_equal(pose.rotations[~near], rotations[~near])
    assert np.array_equal(pose.hips[~near], hips[~near])
    assert report.changed_frames == np.count_nonzero(near)
    assert np.any(pose.rotations[near] != rotations[near])


@pytest.mark.parametrize("stitcher", PLAIN)
def test_seams_are_hidden(small_library: Library, stitcher: str) -> None:
    """The step of the toes' velocity at a seam is a small part of the raw one's."""
    _, _, report = stitched(cuts_of(small_library), stitcher=stitcher)
    assert report.after.seam_step_cm_s < 0.2 * report.before.seam_step_cm_s
    assert [seam.method for seam in report.seams] == [stitcher] * 3


def test_none_leaves_the_seams_as_they_are(small_library: Library) -> None:
    """Poses are the clips' own, laid end to end."""
    clips = cuts_of(small_library)
    _, pose, report = stitched(clips, stitcher="none")
    assert np.array_equal(pose.rotations, np.concatenate([c.pose.rotations for c in clips]))
    assert report.after == report.before


def test_stance_keeps_feet_where_they_stand(small_library: Library) -> None:
    """Planted toes slide by a small part of what springs make of them."""
    clips = cuts_of(small_library, count=12)
    slides = {
        name: stitched(clips, stitcher=name)[2].after.sliding_c_cm_s
        for name in ("spring", "stance")
    }
    assert slides["stance"] < 0.5 * slides["spring"]


def test_windows_that_meet_are_hidden_in_one_go(small_library: Library) -> None:
    """Clips of 10 frames: seams within windows, no frame jumps, feet and all finite."""
    clips = cuts_of(small_library, frames=10, count=20)
    made, pose, report = stitched(clips)
    assert len(chains_after(made.plan.seams, WINDOW, len(made.plan))) == 1
    assert np.isfinite(pose.rotations).all()
    assert report.after.seam_step_cm_s < 0.3 * report.before.seam_step_cm_s


def test_chains_are_worked_on_alike_together_and_alone(small_library: Library) -> None:
    """The first seam of two becomes what it becomes without the second."""
    clips = cuts_of(small_library, count=3)
    (_, both, _), (_, alone, _) = stitched(clips), stitched(clips[:2])
    np.testing.assert_allclose(both.rotations[:290], alone.rotations[:290], atol=1e-6)


def test_the_same_request_gives_the_same_motion(small_library: Library) -> None:
    """Bit by bit, report and all."""
    clips = cuts_of(small_library)
    (_, a, first), (_, b, second) = stitched(clips), stitched(clips)
    assert np.array_equal(a.rotations, b.rotations)
    assert first == second


def test_parts_come_as_they_become_final(small_library: Library) -> None:
    """Header first; poses before the first seam come before any seam was hidden."""
    clips = cuts_of(small_library, count=40)
    made = Stitching(clips, StitchQuery(tuple(clips)))
    parts = made.parts()
    header = next(parts)
    assert isinstance(header, StitchHeader)
    assert header.frames == sum(map(len, clips))
    first = next(parts)
    assert len(first.hips) == len(clips[0])  # type: ignore[union-attr]
    seam = made.plan.seams[0]
    assert np.array_equal(made.motion().hips[seam], made.plan.hips[seam])


def test_strength_scales_the_correction(small_library: Library) -> None:
    """None at 0; the whole at 1; at a half the hips are half as far from the clips'."""
    clips = cuts_of(small_library)
    full, half, none = (stitched(clips, strength=s) for s in (1.0, 0.5, 0.0))
    planned = full[0].plan.hips
    np.testing.assert_allclose(half[1].hips - planned, 0.5 * (full[1].hips - planned), atol=1e-6)
    assert np.array_equal(none[1].rotations, none[0].plan.rotations)


def test_a_mask_keeps_joints(small_library: Library) -> None:
    """A joint with share 0 is the clip's own throughout; others are corrected."""
    clips = cuts_of(small_library)
    made, pose, _ = stitched(clips, joint_mask={"Head": 0.0, "LeftHand": 0.5})
    head, neck = made.plan.skeleton.index("Head"), made.plan.skeleton.index("Neck")
    assert np.array_equal(pose.rotations[:, head], made.plan.rotations[:, head])
    assert not np.array_equal(pose.rotations[:, neck], made.plan.rotations[:, neck])


def test_an_interval_limits_what_is_changed(small_library: Library) -> None:
    """Only the second seam is hidden where the interval holds only it."""
    clips = cuts_of(small_library)
    made, pose, _ = stitched(clips, start_s=4.5, end_s=7.0)
    changed = np.any(pose.rotations != made.plan.rotations, axis=(1, 2))
    assert not changed[:270].any()
    assert changed[300:360].all()
    assert not changed[421:].any()


def test_a_search_finds_better_seams(small_library: Library) -> None:
    """The raw step at seams gets smaller, by no more than the frames that may be left out."""
    clips = cuts_of(small_library, count=12)
    cuts = best_cuts(clips, 20)
    assert all(0 <= cut.before <= 20 and 0 <= cut.after <= 20 for cut in cuts)
    assert best_cuts(clips, 0) == [(0, 0)] * 11
    _, _, kept = stitched(clips)
    _, _, cut_report = stitched(clips, search_frames=20)
    assert cut_report.before.seam_step_cm_s < 0.9 * kept.before.seam_step_cm_s
    assert [(s.cut_before, s.cut_after) for s in cut_report.seams] == cuts


def test_a_search_never_leaves_too_little(small_library: Library) -> None:
    """Ten frames stay of every clip, both ends cut."""
    clips = cuts_of(small_library, frames=14, count=8)
    made, _, _ = stitched(clips, search_frames=60)
    assert np.diff([0, *made.plan.seams, len(made.plan)]).min() >= 10


def test_an_imposed_path_is_followed(small_library: Library) -> None:
    """The root is where the caller says, and looks along the path where no facing is given."""
    clips = cuts_of(small_library)
    end_s = (sum(map(len, clips)) - 1) / 60.0
    times = np.linspace(0.0, end_s, 30)
    path = RootPath(np.stack([np.sin(times), times], axis=-1), times)
    made, pose, _ = stitched(clips, path=path)
    frames = np.arange(len(made.plan)) / 60.0
    np.testing.assert_allclose(pose.root_position[:, 2], frames, atol=1e-3)
    np.testing.assert_allclose(pose.root_position[:, 0], np.sin(frames), atol=0.02)
    heading = np.arctan2(np.cos(frames), 1.0)
    np.testing.assert_allclose(made.plan.root_yaw, heading, atol=0.08)


def test_feet_stand_on_an_imposed_path(small_library: Library) -> None:
    """Where the clips' steps do not fit the path, stance plants feet all along it."""
    walk = small_library.clip("walk-1.4")
    clips = [walk.cut(start, start + 130) for start in (110, 170, 140)]
    times = np.linspace(0.0, (sum(map(len, clips)) - 1) / 60.0, 30)
    path = RootPath(np.stack([0.0 * times, 1.2 * times], axis=-1), times)
    _, _, report = stitched(clips, path=path)
    assert report.after.sliding_c_cm_s < 0.2 * report.before.sliding_c_cm_s
    assert report.changed_frames == sum(map(len, clips))
