"""The learner: networks, PPO, and nothing of what they learn in."""
