"""Training: batches of simulated avatars; everything here runs offline, never beside a live avatar."""
