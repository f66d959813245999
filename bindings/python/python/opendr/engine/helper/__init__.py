"""Helpers around learners."""
