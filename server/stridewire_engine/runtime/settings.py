"""Settings of the tick; the defaults are what ships."""

from dataclasses import dataclass, replace

LEVELS = 3
"""Of giving way to load: not at all, somewhat, as much as possible."""


@dataclass(frozen=True)
class TickSettings:
    """Half-lives in seconds unless said otherwise; a spring's is not a true one, see `springs`."""

    velocity_halflife: float = 0.11
    """Spring of the simulated root's velocity."""
    facing_halflife: float = 0.21
    """Spring of the simulated root's heading."""
    search_interval: float = 0.15
    """Seconds between searches of a character."""
    shortest_interval: float = 0.05
    """Seconds between searches that jumps of the control force."""
    control_jump: float = 0.5
    """Change of the desired velocity since the last search, m/s, that forces one."""
    facing_jump: float = 0.5
    """Change of the goal heading since the last search, radians, that forces one."""
    continuing_bias: float = 0.5
    """A jump must be better than staying by so many of the library's typical costs."""
    least_improvement: float = 0.2
    """And by this share of the cost of staying."""
    reselect_history: float = 0.5
    """What was chosen within so many seconds is not chosen again."""
    idle_speed: float = 0.1
    """Slower than this, in m/s, and asked to stay so, a character does not search."""
    idle_turn: float = 0.3
    """Unless it is to turn by more than so many radians."""
    clip_end_margin: float = 0.1
    """A clip is left at the latest so many seconds before its end."""
    root_halflife: float = 0.12
    """Damper of the root's velocity difference at a jump."""
    adjust_position_halflife: float = 0.1
    """Damper that pulls the character root to the simulated one."""
    adjust_yaw_halflife: float = 0.1
    """Damper that turns the character root to the simulated one."""
    adjust_share: float = 0.2
    """The pull is at most this share of the root's own motion, so that it hides in it."""
    adjust_turn_per_metre: float = 0.6
    """So many radians more may be turned for every metre walked."""
    leash: float = 0.35
    """The simulated root is at most so many metres ahead of the character's."""
    yaw_leash: float = 1.2
    """The simulated heading is at most so many radians off the character's."""
    correction_halflife: float = 0.1
    """Damper of root corrections with ADJUST."""
    foot_halflife: float = 0.1
    """Spring of a foot that locks or unlocks."""
    unlock_distance: float = 0.2
    """A locked foot is let go when the motion is so many metres away from it."""
    most_refined: int = 64
    """Transitions that are refined in one tick; a count, so that a replay decides alike."""

    def giving_way(self, level: int) -> "TickSettings":
        """Return what holds while the runtime gives way to load.

        Args:
            level: 0 for not at all; from 1 on nothing is refined, from 2 on searches are half as
                frequent.
        """
        if level == 0:
            return self
        longer = 2.0 if level > 1 else 1.0
        return replace(self, most_refined=0, search_interval=longer * self.search_interval)
