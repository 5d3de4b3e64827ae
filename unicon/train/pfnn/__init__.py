"""Data and training of the phase-functioned neural network."""
