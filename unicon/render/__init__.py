"""Pictures and videos of clips and recordings, off-screen."""
