"""The clip library on disk."""
