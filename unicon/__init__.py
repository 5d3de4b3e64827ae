"""Live, physics-based avatars: motion capture drives a simulated humanoid through one policy."""

__version__ = "0.1.0"
