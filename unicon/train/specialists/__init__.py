"""Small policies for a few clips each, and one that learns from all of them."""
