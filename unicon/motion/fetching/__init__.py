"""Motions that others hold, over the network."""
