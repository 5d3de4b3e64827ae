"""What the nodes of an avatar share."""
