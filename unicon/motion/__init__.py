"""Motions: clips on our humanoid, the files they are read from, and how those are brought onto it."""
