"""Finds the defects of a motion, mends or cuts them, and says so.

In this order, since each defect hides those after it: repeated frames, the frame rate, what was not captured,
added poses, jumps of the root, flips of joints, idle ends; last what the clip needs that isn't there.
"""

from __future__ import annotations

import numpy as np

from unicon.motion.cleaning import (
    frame_rate,
    frozen_frames,
    joint_flips,
    rest_poses,
    root_drift,
    root_jumps,
    stillness,
)
from unicon.motion.cleaning.body_paths import turn_angles
from unicon.motion.cleaning.decisions import MARKS, Cleaning, Decision, Hints, sentence
from unicon.motion.cleaning.frozen_frames import Frozen
from unicon.motion.cleaning.overrides import Order, Overrides
from unicon.motion.cleaning.support import AIR_S, BESIDE_S, STEP_M, Support
from unicon.motion.cleaning.words import marks_from_words
from unicon.motion.cleaning.workpiece import FEWEST_FRAMES, Workpiece
from unicon.motion.source_motion import SourceMotion

INDEX_FACTOR = 1.3
"""A file that claims so many times the rate of the capture is not believed."""


def clean(motion: SourceMotion, about: Hints, overrides: Overrides) -> Cleaning:
    """Return what of a recognised motion can be used.

    Raises:
        InputFileError: when there is no mapping for its family.
    """
    order = overrides.of(about.file or motion.name)
    last = len(motion.times_s) - 1
    if order.drop:
        return Cleaning((), (Decision("drop", 0, last, "by_hand", sentence(order.reason)),))
    work = Workpiece(motion)
    _obey(work, order)
    words = marks_from_words(about)
    carried = "prop" in words
    for reason, step in (
        ("repeated_frames", _remove_repeats),
        ("no_motion", _drop_motionless),
        ("frozen", _cut_frozen),
        ("interpolated", _cut_interpolated),
        ("root_drift", _cut_drifts),
        ("rest_pose", _cut_added_poses),
        ("root_jump", _cut_root_jumps),
        ("joint_flip", _mend_flips),
        ("idle_end", _cut_idle_ends),
    ):
        if not order.ignores(reason) and work.kept.any() and not (carried and reason == "root_drift"):
            step(work)
        if reason == "repeated_frames" and not order.ignores("frame_rate") and order.rate_hz is None:
            _judge_rate(work, about, carried)
    _drop_lost_roots(work, order)
    parts = work.parts()
    marks = _find_marks(work, order, words) if parts else ()
    return Cleaning(parts, tuple(work.decisions), marks)


def _obey(work: Workpiece, order: Order) -> None:
    """Do what a person ordered."""
    last = len(work.kept) - 1
    if order.keep:
        work.note("keep", 0, last, "by_hand", order.reason)
    if order.rate_hz is not None:
        factor = order.rate_hz / work.paths.rate_hz
        work.scale_rate(factor, "by_hand", f"the rate is {order.rate_hz:g} Hz: {order.reason}")
    for first, last in order.cut:
        work.cut_by_number(first, last, "by_hand", order.reason)


def _remove_repeats(work: Workpiece) -> None:
    repeats = frozen_frames.repeated_frames(work.changes)
    count, total = int(repeats.sum()), len(repeats)
    if count and total - count >= FEWEST_FRAMES:
        where, rate = np.flatnonzero(repeats), work.paths.rate_hz
        text = f"{count} of {total} frames ({rate:.0f} Hz) repeat the one before and were left out"
        work.note("resample", int(where[0]), int(where[-1]), "repeated_frames", text)
        work.select(~repeats)


def _judge_rate(work: Workpiece, about: Hints, carried: bool) -> None:
    """Correct the rate where the index says that the capture was slower, or the motion that it is wrong.

    What falls rightly keeps its rate whatever the index says: slow captures may have been interpolated. What
    is carried by something that isn't there doesn't fall.
    """
    rate, capture = work.paths.rate_hz, about.capture_hz
    evidence = frame_rate.rate_evidence(work.paths, falls=not carried)
    if capture is not None and rate > INDEX_FACTOR * capture and evidence.factor != 1.0:
        text = f"the file says {rate:.0f} Hz, the index of captures {capture:.0f} Hz"
        work.scale_rate(capture / rate, "frame_rate", f"{text}; {evidence.text}" if evidence.text else text)
    elif evidence.factor not in (None, 1.0):
        text = f"at {rate:.0f} Hz {evidence.text}, so the rate is {rate * evidence.factor:.0f} Hz"
        work.scale_rate(evidence.factor, "frame_rate", text)


def _drop_motionless(work: Workpiece) -> None:
    change = work.changes.max()
    if change < frozen_frames.STILL:
        text = f"nothing changes by more than {np.degrees(change):.3f} degrees between frames"
        work.cut(0, len(work.kept), "no_motion", text, "drop")


def _cut_frozen(work: Workpiece) -> None:
    for stretch in frozen_frames.still_stretches(work.changes, work.paths.rate_hz):
        _cut_uncaptured(work, stretch, "frozen", "stands still")


def _cut_interpolated(work: Workpiece) -> None:
    for stretch in frozen_frames.linear_stretches(work.paths):
        _cut_uncaptured(work, stretch, "interpolated", "moves at constant speed")


def _cut_uncaptured(work: Workpiece, stretch: Frozen, reason: str, does: str) -> None:
    inside = stretch.start > 0 and stretch.stop < len(work.kept)
    if not inside or frozen_frames.breaks_off(work.changes, stretch):
        seconds = (stretch.stop - stretch.start) / work.paths.rate_hz
        work.cut(stretch.start, stretch.stop, reason, f"everything {does} for {seconds:.2f} s")


def _cut_drifts(work: Workpiece) -> None:
    pelvis = work.paths.parts["pelvis"]
    for start, stop in root_drift.drifting(work.paths):
        speed = np.median(work.paths.speeds()[start : stop - 1, pelvis])
        seconds = (stop - start) / work.paths.rate_hz
        text = f"the whole body slides with {speed:.2f} m/s for {seconds:.1f} s"
        work.cut(start, stop, "root_drift", text)


def _cut_added_poses(work: Workpiece) -> None:
    for backwards in (False, True):
        paths, frames = work.kept_paths, np.flatnonzero(work.kept)
        if len(frames) < FEWEST_FRAMES:
            return
        if backwards:
            paths, frames = paths.backwards(), frames[::-1]
        pose = rest_poses.added_pose(paths)
        if pose.frames:
            first, last = sorted((int(frames[0]), int(frames[pose.frames - 1])))
            text = f"the arms are out, and a joint turns with {pose.turn_speed:.0f} rad/s into the take"
            work.cut(first, last + 1, "rest_pose", text)


def _cut_root_jumps(work: Workpiece) -> None:
    pelvis = work.paths.parts["pelvis"]
    for start, stop in root_jumps.root_jumps(work.paths, work.kept):
        near = work.paths.take(slice(start - 1, stop + 1))
        speed = near.speeds()[:, pelvis].max()
        spin = (turn_angles(near.rot_w[:, pelvis]) / np.diff(near.times_s)).max()
        text = f"the pelvis moves with up to {speed:.1f} m/s and turns with up to {spin:.0f} rad/s"
        if start < stop:
            work.cut(start, stop, "root_jump", text)
        else:
            work.break_before(start, "root_jump", f"{text} before this frame")


def _mend_flips(work: Workpiece) -> None:
    """Mend thighs first: their repair mends feet too."""
    for thighs in (True, False):
        flips = joint_flips.joint_flips(work.paths, work.kept)
        local_quat = work.motion.local_quat.copy()
        mended = [flip for flip in flips if flip.part.endswith("thigh") == thighs and not flip.breaks]
        for flip in mended:
            joint_flips.repair(work.paths, work.motion.parents, flip, local_quat)
            back = "and back, and was filled" if flip.comes_back else "and was smoothed"
            text = f"{_turn(flip)} {back} from both sides"
            work.note("repair", flip.start, flip.stop - 1, "joint_flip", text)
        if mended:
            work.replace_rotations(local_quat)
    for flip in flips:
        if flip.breaks:
            work.cut(flip.start, flip.stop, "joint_flip", f"{_turn(flip)} and does not come back")


def _turn(flip: joint_flips.Flip) -> str:
    return f"the {flip.part.replace('_', ' ')} turns by {np.degrees(flip.turn_rad):.0f} degrees within 1/30 s"


def _cut_idle_ends(work: Workpiece) -> None:
    frames = np.flatnonzero(work.kept)
    if len(frames) < FEWEST_FRAMES:
        return
    before, after = stillness.idle_ends(work.kept_paths)
    for chosen in (frames[:before], frames[len(frames) - after :]):
        if len(chosen):
            text = f"{len(chosen) / work.paths.rate_hz:.1f} s of stillness were cut"
            work.cut(int(chosen[0]), int(chosen[-1]) + 1, "idle_end", text)


def _drop_lost_roots(work: Workpiece, order: Order) -> None:
    """Drop pieces whose root stands still, of a motion whose root moves."""
    ignored = order.ignores("zero_root") or not work.kept.any()
    if ignored or root_jumps.root_never_moves(work.kept_paths):
        return
    for start, stop in work.pieces():
        if root_jumps.root_never_moves(work.paths.take(slice(start, stop))):
            seconds = (stop - start) / work.paths.rate_hz
            text = f"the root stays at one place for {seconds:.2f} s while the feet move"
            work.cut(start, stop, "zero_root", text, "drop")


def _find_marks(work: Workpiece, order: Order, words: dict[str, str]) -> tuple[str, ...]:
    found = {mark: f"the words say {text!r}" for mark, text in words.items()}
    if root_jumps.root_never_moves(work.kept_paths):
        found["in_place"] = "the root stays at one place while the feet move"
    else:
        found = {**_needs(Support(work.kept_paths)), **found}
    last = len(work.kept) - 1
    for mark, text in found.items():
        if not order.ignores(mark) and mark not in order.unmark:
            work.note("mark", 0, last, mark, text)
    for mark in order.mark:
        work.note("mark", 0, last, "by_hand", f"marked {mark}: {order.reason}")
    wanted = {decision.reason for decision in work.decisions if decision.what == "mark"} | set(order.mark)
    return tuple(mark for mark in MARKS if mark in wanted)


def _needs(support: Support) -> dict[str, str]:
    """Return the marks that the motion gives, each with the figure."""
    heights = support.standing_heights()
    low, high = np.percentile(heights, (5, 95)) if len(heights) else (0.0, 0.0)
    if high - low > STEP_M:
        return {"uneven_ground": f"the standing feet are at heights {high - low:.2f} m apart"}
    air_s, beside_s = support.longest_in_air(), support.longest_beside()
    if air_s > AIR_S:
        return {"prop": f"nothing is near the floor for {air_s:.1f} s"}
    if beside_s > BESIDE_S:
        return {"prop": f"it rests for {beside_s:.1f} s with its weight beside what is lowest"}
    return {}
