"""Brings a source's poses onto the humanoid."""
