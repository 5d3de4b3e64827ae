"""What a clip's description says of things that the data lacks: bars, chairs, stairs."""

from __future__ import annotations

import re

from unicon.motion.cleaning.decisions import Hints

_PROPS = (
    r"playground|\bclimb\w*|\bladders?\b|\bjungle gym\b|\bledge\b|\btrapeze\b|\btrampoline\b",
    r"\bhang(s|ing)?\b(?! (out|a picture|picture))|\bon ropes?\b|\bgrips? (a )?bar\b",
    r"\b(monkey|parallel|pull up) bars?\b|\bswing(s|ing)? (on|from|body)\b",
    r"\bstools?\b|\bstepstool\b|\bchairs?\b|\bbench\b|\bsofa\b|\bseat(ed|s)?\b|\bdriving( loop)?$",
    r"\bsit(s|ting)?\b(?! ?ups?\b)(?!.*\b(ground|floor|cross(ed)? legs?)\b)",
    r"\b(bicycle|skateboard)\w*|\bball (mount|walk)\b|\blean(s|ing)?( with hands)? (on|against)\b",
    r"\b(pulls|lifts|carries) up [ab]\b|\b[ab] (pulls|lifts|carries) up\b",
)
_GROUND = (
    r"\buneven\b|\bterrain\b|\bstairs?\w*|\bslope\b|\bvarying height\b",
    r"\bclimb \d+ steps?\b|\bsteps? (up|down) (on|off|from)\b",
)
_SESSIONS = re.compile(r"skateboard")
"""What holds for all takes of a session, whatever each of them is about."""
WORDS = {"prop": re.compile("|".join(_PROPS)), "uneven_ground": re.compile("|".join(_GROUND))}
"""Pattern of each mark, for words in small letters."""


def marks_from_words(about: Hints) -> dict[str, str]:
    """Return the marks that the words give, each with the words that gave it."""
    stem = about.file.rpartition("/")[2].rpartition(".")[0]
    session = not about.description or _SESSIONS.search(_plain(about.context))
    context = about.context if session else ""
    found = {}
    for mark, pattern in WORDS.items():
        for text in (about.description, context, stem):
            match = pattern.search(_plain(text))
            if match:
                found[mark] = match.group(0)
                break
    return found


def _plain(text: str) -> str:
    """Return words in small letters, ``CamelCase`` and ``under_scores`` taken apart."""
    text = re.sub(r"([a-z])([A-Z])", r"\1 \2", text)
    return " ".join(re.sub(r"[_\-.,;/]+", " ", text).lower().split())
