"""Control: one module per task."""

from opendr.control import reinforcement_learning as reinforcement_learning
