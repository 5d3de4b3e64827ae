"""The one family of errors that a user may see.

Every message is a single sentence: what is wrong, where (file, line or field), what was expected and
what to do. Command-line tools and nodes print it without a traceback and exit with status 2.
"""

from __future__ import annotations


class UniconError(Exception):
    """Base of all errors that are the input's or the machine's fault, never the program's."""


class InputFileError(UniconError):
    """A file cannot be used: it is missing, empty, truncated, or does not say what it should."""


class UnknownNameError(UniconError):
    """A name (motion, policy, source, body) is not known; the message lists the nearest ones."""
