"""`make show-search`: exact weights per request, any filter, a million frames, and proof.

Bars stand here as they were asked for. Needs the capture (STRIDEWIRE_DATA); speed wants a machine
that does nothing else. Draws `build/show/search-growth.png`.
"""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
from points import ROOT, Point, show
from search_libraries import captured, million, reduced

from stridewire._errors import StridewireError
from stridewire._messages import CharacterSpec, ClipTime, Open, SearchQuery, Step
from stridewire.motion.array_types import Floats
from stridewire_engine.building import open_library
from stridewire_engine.matching import proof
from stridewire_engine.matching.candidates import CandidateSet, Index
from stridewire_engine.matching.features import clip_features
from stridewire_engine.matching.index import ExactIndex, augment_queries
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import Runtime

BATCH = 32
ROUNDS = 40
OPENING = """
import sys, time, resource
start = time.perf_counter()
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher
loaded = time.perf_counter()
library = Library.open(sys.argv[1])
opened = time.perf_counter()
Matcher(library)
ready = time.perf_counter()
mapped = not library.rotations.flags.owndata
rss = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(opened - loaded, ready - loaded, mapped, rss, library.rotations.nbytes / 2**20)
"""


def exact() -> Iterator[Point]:
    """The exact index equals brute force on 1,000 random queries x weights x filters."""
    matcher = Matcher(open_library())
    rng = np.random.default_rng(2)
    for text in ("idle | backward", "run", "turn & !walk"):
        among = matcher.candidates.get(text, "filter")
        for name, spread in (("the schema's weights", 0.0), ("random weights", 1.0)):
            queries, weights = _queries(matcher, rng, 1000, spread)
            found = matcher.search(queries, weights, np.full((1000, 1), -1), candidates=among)
            wrong = sum(
                not np.isclose(cost, _brute_force(matcher, among, query, by), rtol=1e-9)
                for query, by, cost in zip(queries, weights, found.costs[:, 0], strict=True)
            )
            what = f"exact, {name}, filter {text!r}, {len(among)} rows: unlike brute force"
            yield Point(what, f"{wrong} of 1000", "0", wrong == 0 and among.is_exact)


def approximate() -> Iterator[Point]:
    """Measure the worst cell over other people's queries, on capture and on a million frames."""
    others = [captured("cmu-heldout").clip(c.name) for c in captured("cmu-heldout").clips]
    for library in (captured("cmu-seen"), captured("lafan1"), million()):
        matcher = Matcher(library)
        raw = np.concatenate([clip_features(matcher.schema, clip) for clip in others])
        rng = np.random.default_rng(77)
        queries = proof.probe_queries(matcher, matcher.normalisation.apply(raw), rng)
        cells = [*proof.prove(matcher, queries, rng), _one_percent(matcher, queries, rng)]
        recall, ratio = min(c.recall for c in cells), max(c.cost_ratio for c in cells)
        size = f"{library.name}, {len(library.features)} frames, {len(cells)} cells"
        yield Point(f"worst recall@1, {size}", f"{recall:.3f}", ">= 0.99", recall >= 0.99)
        yield Point(f"worst cost ratio, {size}", f"{ratio:.4f}", "<= 1.01", ratio <= 1.01)


def _one_percent(matcher: Matcher, queries: Floats, rng: np.random.Generator) -> proof.Cell:
    """Measure a filter that a hundredth of the rows satisfies, under random weights."""
    library = matcher.library
    some = rng.random(len(library.features)) < 0.01
    rows = np.flatnonzero(some & library.startable)
    among = matcher.candidates.of_rows("one percent", some, rows)
    weights = matcher.schema.weights * 4.0 ** rng.uniform(-1, 1, (len(queries), 5))
    found = matcher.search(queries, weights, np.full((len(queries), 1), -1), candidates=among)
    best = np.array(
        [_brute_force(matcher, among, q, w) for q, w in zip(queries, weights, strict=True)]
    )
    hit = float(np.mean(found.costs[:, 0] <= best * (1 + 1e-9)))
    ratio = float(found.costs[:, 0].sum() / best.sum())
    return proof.Cell("random", "one percent", len(rows), hit, ratio)


def speed() -> Iterator[Point]:
    """Time 100 k frames, batch 32, weights on, a filter that keeps about two thirds."""
    matcher = Matcher(reduced(100_000))
    rng = np.random.default_rng(3)
    broad = _filter_near(matcher, 2 / 3)
    small = _filter_near(matcher, 0.15)
    queries, weights = _queries(matcher, rng, BATCH, 1.0)
    nothing = np.full((BATCH, 1), -1)
    each = {
        name: _time(lambda among=among: matcher.search(queries, weights, nothing, 1, among)) / BATCH
        for name, among in (("broad", broad), ("small", small))
    }
    augmented = augment_queries(matcher.schema, queries, weights)
    scan = _exact_of(matcher, broad)
    batch = _time(lambda: scan.nearest(augmented, 64)) / BATCH
    alone = _time(lambda: scan.nearest(augmented[:1], 64))
    share = len(broad) / len(matcher.candidates.everything)
    what = f"a query, filter {broad.text!r} ({100 * share:.0f} % of 100 k), batch 32"
    yield Point(what, f"{each['broad']:.0f} us", "<= 60 us", each["broad"] <= 60)
    what = f"a query, filter {small.text!r} ({len(small)} rows, scanned: {small.is_exact})"
    yield Point(what, f"{each['small']:.0f} us", "<= 250 us", each["small"] <= 250)
    faster = min(batch, alone) / each["broad"]
    text = f"{faster:.0f} x (exact scan {alone:.0f} us at batch 1, {batch:.0f} us at 32)"
    yield Point("faster than the exact scan", text, ">= 20 x", faster >= 20)


def growth() -> Iterator[Point]:
    """Plot the growth from 10 k to 1 M beside exact, and ask that it is sublinear."""
    sizes = (10_000, 30_000, 100_000, 300_000, 1_000_000)
    rng = np.random.default_rng(4)
    rows = []
    for size in sizes:
        matcher = Matcher(reduced(size))
        queries, weights = _queries(matcher, rng, BATCH, 1.0)
        nothing = np.full((BATCH, 1), -1)
        augmented = augment_queries(matcher.schema, queries, weights)
        everything = matcher.candidates.everything
        scan = _exact_of(matcher, everything)
        ours = _time(partial(matcher.search, queries, weights, nothing)) / BATCH
        scanned = _time(partial(scan.nearest, augmented, 64), rounds=6) / BATCH
        rows.append((size, ours, scanned))
    _plot(rows)
    exponent = np.polyfit(np.log(sizes), np.log([row[1] for row in rows]), 1)[0]
    text = ", ".join(f"{size // 1000} k: {ours:.0f} us ({all_:.0f})" for size, ours, all_ in rows)
    what = "a query, frames: time (exact scan)"
    yield Point(what, f"{text}; exponent {exponent:.2f}", "sublinear", exponent < 1.0)


def opening() -> Iterator[Point]:
    """A 1 M-frame library opens in under 2 s without copying poses; resident memory stated."""
    path = str(million().path)
    command = [sys.executable, "-c", OPENING, path]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    opened, ready, mapped, rss, poses = run.stdout.split()
    text = f"{float(opened):.2f} s, ready to search after {float(ready):.2f} s"
    yield Point("1 M frames open", text, "under 2 s", float(ready) < 2.0)
    text = (
        f"mapped: {mapped}, {float(rss):.0f} MB resident beside {float(poses):.0f} MB of rotations"
    )
    yield Point("poses are not copied", text, "stated", mapped == "True")


def one_search_a_filter() -> Iterator[Point]:
    """The tick makes one search per distinct filter, counted."""
    runtime = Runtime([open_library()])
    filters = ("walk", "", "walk", "idle | walk", "", "run")
    specs = [CharacterSpec(i, filter=text) for i, text in enumerate(filters)]
    session = runtime.open(Open(specs))
    calls: list[int] = []
    search = Matcher.search

    def counted(self: Matcher, queries: Floats, *rest: object) -> object:
        calls.append(len(queries))
        return search(self, queries, *rest)  # type: ignore[arg-type]

    Matcher.search = counted  # type: ignore[method-assign, assignment]
    runtime.advance([(session, Step(1))])
    Matcher.search = search  # type: ignore[method-assign]
    text = f"{len(calls)} searches for {len(filters)} characters of {len(set(filters))} filters"
    yield Point("searches of a tick", text, "one a filter", len(calls) == len(set(filters)))


def bad_input() -> Iterator[Point]:
    """Precise status, field and remedy."""
    runtime = Runtime([open_library()])
    clip = runtime.library("").clips[0].name
    start = ClipTime(clip, 0.5)
    channels = [channel.name for channel in Matcher(runtime.library("")).schema.channels]
    cases = {
        "malformed expression": SearchQuery(start, filter="walk & (run"),
        "unknown tag": SearchQuery(start, filter="wlak"),
        "unknown channel": SearchQuery(start, weights={"elbow": 1.0}),
        "negative weight": SearchQuery(start, weights={channels[0]: -1.0}),
        "NaN weight": SearchQuery(start, weights={channels[0]: float("nan")}),
        "all-zero weights": SearchQuery(start, weights=dict.fromkeys(channels, 0.0)),
        "k of 0": SearchQuery(start, k=0),
        "k of 1e6": SearchQuery(start, k=10**6),
        "a filter that nothing satisfies": SearchQuery(start, filter="idle & run"),
        "a clip time outside the clip": SearchQuery(ClipTime(clip, 1e4)),
    }
    for what, query in cases.items():
        try:
            runtime.search(query)
            yield Point(what, "accepted", "status, field, remedy", False)
        except StridewireError as error:
            said = f"{error.code}: {error.violations[0]}".replace("\n", " ")
            fine = error.code == "INVALID_ARGUMENT" and bool(error.violations[0].field)
            yield Point(what, said, "status, field, remedy", fine)


def _queries(
    matcher: Matcher, rng: np.random.Generator, count: int, spread: float
) -> tuple[Floats, Floats]:
    """Return rows off the data by half a deviation, and weights spread by so many factors of 4."""
    features = matcher.library.features
    queries = features[rng.integers(len(features), size=count)].astype(np.float64)
    queries += rng.normal(scale=0.5, size=queries.shape)
    weights = matcher.schema.weights * 4.0 ** rng.uniform(-spread, spread, (count, 5))
    return queries, weights


def _brute_force(matcher: Matcher, among: CandidateSet, query: Floats, weights: Floats) -> float:
    rows = matcher.library.features[among.rows].astype(np.float64) - query
    return float((rows**2 * weights[matcher.schema.channel_of]).sum(axis=1).min())


def _filter_near(matcher: Matcher, share: float) -> CandidateSet:
    """Return the tag, or pair of tags, whose rows are nearest to a share of all."""
    tags = matcher.library.tag_names
    texts = [*tags, *(f"{a} | {b}" for a in tags for b in tags if a < b)]
    bits = matcher.library.tag_bits
    startable = matcher.library.startable

    def held(text: str) -> float:
        names = text.split(" | ")
        mask = np.uint64(sum(1 << tags.index(name) for name in names))
        return abs(float(((bits & mask != 0) & startable).sum() / startable.sum()) - share)

    return matcher.candidates.get(min(texts, key=held), "filter")


def _exact_of(matcher: Matcher, among: CandidateSet) -> CandidateSet:
    """Return the same rows, scanned one by one."""
    features = matcher.library.features
    index = ExactIndex(matcher.schema, features, matcher.bias, among.rows)
    return CandidateSet(among.text, among.satisfied, among.rows, None, lambda: Index(index))


def _time(call: Callable[[], object], rounds: int = ROUNDS) -> float:
    """Return the median time of a call in microseconds, warmed up."""
    for _ in range(3):
        call()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        times.append(1e6 * (time.perf_counter() - start))
    return float(np.median(times))


def _plot(rows: list[tuple[int, float, float]]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    sizes, ours, scanned = zip(*rows, strict=True)
    figure, axes = pyplot.subplots(figsize=(6, 4))
    axes.loglog(sizes, ours, "o-", label="stridewire")
    axes.loglog(sizes, scanned, "s--", label="exact scan, batch 32")
    axes.set(xlabel="frames", ylabel="µs a query", title="search under random weights, one thread")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(ROOT / "build" / "show" / "search-growth.png", dpi=110)


if __name__ == "__main__":
    stages = [
        exact,
        one_search_a_filter,
        bad_input,
        approximate,
        speed,
        growth,
        opening,
    ]
    sys.exit(show("search", stages))
