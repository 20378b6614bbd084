"""The page in a real browser: driven by keys and touch, it draws what the server sent."""

import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest

from browsing import Visit, needs_browser, visit
from serving import DEADLINE_S, LoopThread
from stridewire._messages import Frame, Step, StreamError
from stridewire.formats.bvh_writing import write_bvh
from stridewire.formats.reading import read_motion
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.kinematics import forward_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session
from stridewire_server.page.file_view import file_view
from stridewire_server.page.site import Site, about
from stridewire_server.server import AnimationServer
from stridewire_server.settings import ServerSettings
from stridewire_server.websocket.door import WebSocketDoor

pytestmark = [needs_browser, pytest.mark.timeout(300)]

HELD_S = 5.0
ONE_MM = 1e-3


class Watched(Runtime):
    """Keeps the frames that it makes, by their numbers."""

    def __init__(self, library: Library) -> None:
        super().__init__([library])
        self.made: dict[int, Frame] = {}
        self._lock = threading.Lock()

    def advance(
        self, due: Sequence[tuple[Session, Step | float]], level: int = 0
    ) -> list[tuple[Frame, StreamError | None]]:
        """Advance, and keep."""
        advanced = super().advance(due, level)
        with self._lock:
            self.made.update({frame.frame: frame for frame, _ in advanced})
        return advanced


class Played:
    """A page that drives a character, and the runtime behind it."""

    def __init__(self, visiting: Visit, runtime: Watched, host: str) -> None:
        self.visit = visiting
        self.page = visiting.page
        self.runtime = runtime
        self.host = host

    def check(self) -> None:
        """Nothing went wrong in the page, and it asked nobody but its server."""
        assert self.visit.wrong == []
        foreign = [url for url in self.visit.requests if f"//{self.host}/" not in url]
        assert [url for url in foreign if not url.startswith("blob:")] == []


@pytest.fixture
def played(
    loop_thread: LoopThread, small_library: Library, request: pytest.FixtureRequest
) -> Iterator[Played]:
    """Open the page over the small library, wait until it draws; check it at the end."""
    runtime = Watched(small_library)
    settings = ServerSettings("127.0.0.1:0", websocket="127.0.0.1:0", drain_s=0.2)

    async def start() -> AnimationServer:
        server = AnimationServer(runtime, settings, Site(about(runtime)))
        await server.start()
        return server

    server = loop_thread.call(start())
    host = server.websocket_address
    try:
        with visit(f"http://{host}/", **getattr(request, "param", {})) as visiting:
            visiting.wait("play.drawn")
            played = Played(visiting, runtime, host)
            yield played
            played.check()
    finally:
        loop_thread.call(server.stop())


def middle_of_first_bone(frame: Frame, row: int = 0) -> np.ndarray:
    """Return the point between hips and spine of a frame's character in the world."""
    pose = Pose(
        frame.root[row : row + 1, :3],
        frame.root[row : row + 1, 3:],
        frame.hips[row : row + 1],
        frame.rotations[row : row + 1],
    )
    positions, _ = forward_world(REFERENCE, pose)
    spine = REFERENCE.names.index("Spine")
    return np.asarray(positions[0, [0, spine]].mean(axis=0))


def heading(root: np.ndarray) -> float:
    """Return the yaw of a root's transform."""
    return 2.0 * float(np.arctan2(root[5], root[3]))


def drawn(played: Played) -> tuple[int, np.ndarray, np.ndarray]:
    """Return number and root of the frame that is drawn, and where its first trunk bone is."""
    number, root, matrix = played.visit.ask(
        "const bone = play.bodies.bones.find(({ joint }) => joint === 9);"
        "return [play.drawn.frame, play.drawn.root, [...bone.mesh.instanceMatrix.array]];"
    )
    return int(number), np.array(root), np.array(matrix[12:15])


def test_keys_walk_and_turn_and_what_is_drawn_is_what_was_sent(played: Played) -> None:
    """W for 5 s, then A: the drawn root and limb are those of the server's frame of that number."""
    page = played.page
    before = played.visit.ask("return [play.readout.frames, play.newest.frame];")
    page.keyboard.down("KeyW")
    compared = 0
    for _ in range(10):
        page.wait_for_timeout(100.0 * HELD_S)
        number, root, bone = drawn(played)
        frame = played.runtime.made[number]
        np.testing.assert_allclose(root, frame.root[0], atol=1e-6)
        np.testing.assert_allclose(bone, middle_of_first_bone(frame), atol=ONE_MM)
        compared += 1
    after = played.visit.ask("return [play.readout.frames, play.newest.frame];")
    # what the page took of what the server made meanwhile; a busy machine makes fewer
    taken, made = after[0] - before[0], after[1] - before[1]
    assert taken > 0.8 * made
    assert made > 100
    walked = played.runtime.made[int(after[1])].root[0]
    page.keyboard.down("KeyA")
    page.keyboard.up("KeyW")
    page.wait_for_timeout(2000.0)
    page.keyboard.up("KeyA")
    turned = drawn(played)[1]
    assert compared == 10
    assert np.hypot(walked[0], walked[2]) > 1.5
    assert (
        abs(2.0 * np.arctan2(turned[5], turned[3]) - 2.0 * np.arctan2(walked[5], walked[3])) > 0.5
    )
    figures = played.visit.ask("return [play.readout.framesPerSecond, play.readout.latency];")
    print(f"{figures[0]:.1f} frames/s arrived, control to frame {figures[1]:.1f} ms (median)")


def test_the_timeline_looks_back_while_the_session_goes_on(played: Played) -> None:
    """Dragged to the left, an older frame is drawn; the newest goes on; the button comes back."""
    page = played.page
    page.keyboard.down("KeyW")
    played.visit.wait("play.history.transitions.length > 2 && play.history.end > 3")
    box = page.locator("#timeline").bounding_box()
    assert box is not None
    x = box["x"] + 16 + 0.12 * (box["width"] - 16)
    page.mouse.move(x, box["y"] + 30)
    page.mouse.down()
    page.mouse.up()
    page.wait_for_timeout(500.0)
    number, root, _ = drawn(played)
    newest = played.visit.ask("return play.newest.frame;")
    assert number < newest - 30
    np.testing.assert_allclose(root, played.runtime.made[number].root[0], atol=1e-6)
    assert "cost" in page.locator("#details").inner_text()
    page.locator("#present").click()
    played.visit.wait(f"play.drawn.frame > {newest}")


@pytest.mark.parametrize("played", [{"size": (900, 700)}], indirect=True)
def test_switches_change_the_running_session(played: Played) -> None:
    """Stitcher, foot lock, filter and crowd are taken without complaint; nonsense is told."""
    page = played.page
    page.get_by_label("stitcher").select_option("none")
    page.get_by_label("foot lock").uncheck()
    page.get_by_label("raw ghost").check()
    page.get_by_label("filter").fill("walk")
    page.get_by_label("filter").press("Enter")
    page.get_by_label("crowd of 64").check()
    played.visit.wait("play.newest.characters.length === 64 && play.bodies.head.count === 64")
    assert page.locator("#message").is_hidden()
    page.get_by_label("crowd of 64").uncheck()
    played.visit.wait("play.newest.characters.length === 1")
    page.get_by_label("filter").fill("fly")
    page.get_by_label("filter").press("Enter")
    page.locator("#message").wait_for(timeout=1e3 * DEADLINE_S)
    assert "fly" in page.locator("#message").inner_text()
    assert played.visit.ask("return play.panel.settings.filter;") == "walk"


@pytest.mark.parametrize("played", [{"size": (900, 700)}], indirect=True)
def test_what_was_walked_is_saved_as_bvh(played: Played, tmp_path: Path) -> None:
    """The file holds the recorded seconds, and the hips go as far as they were seen to go."""
    page = played.page
    page.keyboard.down("KeyW")
    page.locator("#record").click()
    first = played.visit.ask("return play.history.frames.at(-1).x;")
    played.visit.wait("play.history.end > play.recordedFrom + 2")
    page.locator("#record").click()
    with page.expect_download() as download:
        page.locator("#bvh").click()
    path = tmp_path / "walked.bvh"
    download.value.save_as(path)
    motion = read_motion(path)
    assert motion.frame_rate == pytest.approx(60.0, abs=0.01)
    assert len(motion) >= 120
    assert first is not None


@pytest.mark.parametrize(
    "played", [{"size": (390, 780), "has_touch": True, "is_mobile": True}], indirect=True
)
def test_a_phone_is_driven_by_touch(played: Played) -> None:
    """At phone width nothing is cut off, and the stick makes the character walk."""
    page = played.page
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    for selector in ("#view", "#timeline", "#stick", "#more"):
        box = page.locator(selector).bounding_box()
        assert box is not None
        assert box["x"] >= 0.0
        assert box["x"] + box["width"] <= 390.0
    box = page.locator("#stick").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 58, box["y"] + 58)
    page.mouse.down()
    page.mouse.move(box["x"] + 58, box["y"] + 8, steps=4)
    played.visit.wait("Math.hypot(play.drawn.root[0], play.drawn.root[2]) > 0.8")
    page.mouse.up()


def test_files_are_shown_side_by_side(
    loop_thread: LoopThread, swaying_clip: Clip, tmp_path: Path
) -> None:
    """Two bodies 1.6 m apart at the same moment; the bar leads to any other."""
    paths = [tmp_path / "one.bvh", tmp_path / "two.bvh"]
    for path in paths:
        write_bvh(path, swaying_clip)
    site = Site(*file_view(paths))
    settings = ServerSettings(websocket="127.0.0.1:0")

    async def start() -> tuple[WebSocketDoor, str]:
        door = WebSocketDoor(settings, 1 << 20, site.talks, site.find)
        return door, await door.start()

    door, host = loop_thread.call(start())
    try:
        with visit(f"http://{host}/") as visiting:
            visiting.wait("play.time > 0 && play.subjects.every(({ bodies }) => bodies)")
            visiting.page.get_by_label("time").fill("1.5")
            visiting.wait("play.time === 1.5 && !play.playing")
            visiting.page.wait_for_timeout(300.0)
            places = visiting.ask(
                "return play.subjects.map(({ bodies }) =>"
                " [...bodies.bones[0].mesh.instanceMatrix.array.slice(12, 15)]);"
            )
            assert np.array(places[1]) - places[0] == pytest.approx([1.6, 0.0, 0.0], abs=1e-4)
            assert visiting.wrong == []
    finally:
        loop_thread.call(door.stop())
