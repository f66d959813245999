"""Planning: a module a task."""

from opendr.planning import end_to_end_planning as end_to_end_planning
