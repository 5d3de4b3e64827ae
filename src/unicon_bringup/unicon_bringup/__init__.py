"""Starts the nodes of an avatar together."""
