"""Planning: one module per task."""

from opendr.planning import end_to_end_planning as end_to_end_planning
