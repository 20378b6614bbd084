"""Stitching: clips in order become one motion, part by part as it becomes final."""

from collections.abc import Iterator, Sequence

import numpy as np

from stridewire import __version__
from stridewire._messages import Seam, StitchHeader, StitchPart, StitchQuery, StitchReport
from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.clip import Clip, Pose
from stridewire_engine.networks.rmr import Refiner
from stridewire_engine.stitchers import STITCHERS
from stridewire_engine.stitching import chains as spans
from stridewire_engine.stitching import methods
from stridewire_engine.stitching.alignment import lay
from stridewire_engine.stitching.chains import Chains
from stridewire_engine.stitching.correction import mix, within
from stridewire_engine.stitching.cuts import Cut, best_cuts, cut_clips
from stridewire_engine.stitching.figures import figures, leg_paths
from stridewire_engine.stitching.methods import Method, Share
from stridewire_engine.stitching.path import impose
from stridewire_engine.stitching.run import run

_CHAINS_AT_ONCE = 8
_FRAMES_A_PART = 2000


class Stitching:
    """One motion in the making."""

    def __init__(
        self, clips: Sequence[Clip], query: StitchQuery, refiner: Refiner | None = None
    ) -> None:
        """Lay the clips end to end.

        Args:
            clips: Of one skeleton and frame rate, found to be allowed.
            query: Says how; its own clips are not looked at.
            refiner: The network, where there is one.
        """
        self._refiner = refiner
        self._query = query
        self._cuts = best_cuts(clips, query.search_frames)
        plan = lay(cut_clips(clips, self._cuts))
        self.plan = plan if query.path is None else impose(plan, query.path)
        """The clips laid end to end."""
        self._hips, self._rotations = self.plan.hips.copy(), self.plan.rotations.copy()
        self._methods: dict[int, Method] = {}
        mask = query.joint_mask
        names = self.plan.skeleton.names
        self._joint_shares = query.strength * np.array([mask.get(name, 1.0) for name in names])

    def parts(self) -> Iterator[StitchPart]:
        """Yield the header, then poses as they become final, then the report."""
        plan = self.plan
        yield StitchHeader(plan.skeleton, plan.frame_rate, len(plan))
        chains, stays = self._chains()
        shares = spans.shares(chains, len(plan), stays) * self._interval()
        final = 0
        for first in range(0, len(chains), _CHAINS_AT_ONCE):
            group = chains.part(first, first + _CHAINS_AT_ONCE)
            yield from self._poses(final, final := int(group.starts[0]))
            self._work(group, shares)
            yield from self._poses(final, final := int(group.ends[-1]))
        yield from self._poses(final, len(plan))
        yield self._report(shares > 0.0)

    def motion(self) -> Pose:
        """Return all poses `(T, …)` as they are by now."""
        return self._pose(slice(None))

    def _chains(self) -> tuple[Chains, bool]:
        """Return what is worked on, and whether the work lasts to the end."""
        plan, window = self.plan, round(self._query.window_s * self.plan.frame_rate)
        every = spans.whole(len(plan))
        if plan.imposed and methods.plants_feet(self._query.stitcher):
            # no step of the clips fits the path, so that feet are planted everywhere
            return every, True
        return spans.chains_after(plan.seams, window, len(plan)), False

    def _interval(self) -> Floats:
        rate, frames = self.plan.frame_rate, len(self.plan)
        end_s = self._query.end_s or frames / rate
        return within(frames, round(self._query.start_s * rate), min(round(end_s * rate), frames))

    def _work(self, chains: Chains, shown: Floats) -> None:
        """Hide the seams of chains."""
        for share in methods.shares(self.plan, chains, self._query, self._refiner):
            rows = share.rows
            self._work_on(Chains(chains.starts[rows], chains.ends[rows]), share, shown)

    def _work_on(self, chains: Chains, share: Share, shown: Floats) -> None:
        stitcher = next(s for s in STITCHERS if s.name == share.method.stitcher)
        made = run(self.plan, stitcher, chains, share.guides)
        for i, (start, end) in enumerate(zip(chains.starts, chains.ends, strict=True)):
            frames = slice(start, end)
            self._hips[frames], self._rotations[frames] = mix(
                (self.plan.hips[frames], self.plan.rotations[frames]),
                (made.hips[i, : end - start], made.rotations[i, : end - start]),
                shown[frames],
                self._joint_shares,
            )
            for seam in self.plan.seams[(self.plan.seams >= start) & (self.plan.seams < end)]:
                self._methods[int(seam)] = share.method

    def _poses(self, start: int, stop: int) -> Iterator[Pose]:
        for first in range(start, stop, _FRAMES_A_PART):
            yield self._pose(slice(first, min(first + _FRAMES_A_PART, stop)))

    def _pose(self, frames: slice) -> Pose:
        planned = self.plan.pose(frames)
        return Pose(
            planned.root_position,
            planned.root_rotation,
            self._hips[frames],
            self._rotations[frames],
        )

    def _report(self, changed: Flags) -> StitchReport:
        plan = self.plan
        before = leg_paths(plan, plan.hips, plan.rotations)
        after = leg_paths(plan, self._hips, self._rotations)
        return StitchReport(
            tuple(
                self._seam(int(frame), cut)
                for frame, cut in zip(plan.seams, self._cuts, strict=True)
            ),
            figures(plan, before, changed),
            figures(plan, after, changed),
            figures(plan, before, ~changed),
            int(np.count_nonzero(changed)),
            self._query.window_s,
            self._models(),
            __version__,
        )

    def _seam(self, frame: int, cut: Cut) -> Seam:
        how = self._methods[frame]
        return Seam(frame, how.name, how.reason, cut.before, cut.after)

    def _models(self) -> dict[str, str]:
        """Return the networks that were used."""
        used = any(how.name == methods.REFINE for how in self._methods.values())
        return {"rmr": self._refiner.model.hash} if used and self._refiner is not None else {}
