"""Puts motions on the ground so that physics can follow them, and measures them."""
