"""OpenDR's tools around learners."""
