"""Where a person steers to, as a path ahead, and the poses that follow it."""
