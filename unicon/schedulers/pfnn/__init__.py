"""The phase-functioned neural network that makes the next pose of a walk (Holden, Komura, Saito 2017)."""
