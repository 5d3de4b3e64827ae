"""What the policy learns in: many avatars that track clips."""
