"""The option `--mask JOINT=SHARE`, of commands that change some joints more than others."""

from collections import Counter
from collections.abc import Sequence

import click
import numpy as np

from stridewire.motion.skeleton import REFERENCE, SkeletonError


def joint_shares(mask: Sequence[str]) -> dict[str, float]:
    """Return the shares that are given, by joint of the reference skeleton.

    Raises:
        click.BadParameter: If a joint is unknown or given twice, or a share is not from 0 to 1.
    """
    names = [text.partition("=")[0] for text in mask]
    for name, count in Counter(names).items():
        if count > 1:
            raise click.BadParameter(f"{name} is given {count} times", param_hint="--mask")
    return {name: _share(text) for name, text in zip(names, mask, strict=True)}


def _share(text: str) -> float:
    name, _, share = text.partition("=")
    try:
        REFERENCE.index(name)
        value = float(share)
    except SkeletonError as error:
        raise click.BadParameter(str(error), param_hint="--mask") from error
    except ValueError:
        value = np.nan
    if not 0.0 <= value <= 1.0:
        raise click.BadParameter(
            f"{text!r}; expected JOINT=SHARE, a share from 0 to 1", param_hint="--mask"
        )
    return value
