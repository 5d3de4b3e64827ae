"""The quality-of-service profiles of the graph, named once."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def _profile(reliable: bool, latched: bool, depth: int) -> QoSProfile:
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
    )


STREAM = _profile(reliable=True, latched=False, depth=60)
"""Publishers of streams: a second of them is kept for resending to a recorder, which must not lose any.

With a depth of 1 a message that a busy machine delivers late is overwritten before it can be resent.
Subscribers that only want the newest are best effort and never cause a resend.
"""
STREAM_SUBSCRIBER = _profile(reliable=False, latched=False, depth=5)
"""Subscribers of streams that only want the newest."""
COMMAND = _profile(reliable=True, latched=False, depth=10)
"""Commands and, in lockstep, target frames: nothing may be lost."""
LATCHED = _profile(reliable=True, latched=True, depth=1)
"""What is said once and kept for whoever comes later."""
EVENTS = _profile(reliable=True, latched=True, depth=1000)
"""The executor's events since its start, all kept for a recorder that comes later."""
EVERYTHING = _profile(reliable=True, latched=False, depth=1000)
"""A recorder's subscription, which must not lose anything."""
EVERYTHING_LATCHED = _profile(reliable=True, latched=True, depth=1000)
"""The same for latched topics."""
ANYTHING = _profile(reliable=False, latched=False, depth=1000)
"""A recorder's subscription to a publisher that is best effort."""
