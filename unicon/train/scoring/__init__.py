"""Scores of a policy, and its folder with them."""
