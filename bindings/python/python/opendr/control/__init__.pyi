"""Control: a module a task."""

from opendr.control import reinforcement_learning as reinforcement_learning
