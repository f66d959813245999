"""Base classes of learners of OpenDR that have further methods."""
