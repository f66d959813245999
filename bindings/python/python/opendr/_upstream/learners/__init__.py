"""What single learners of OpenDR have beside the methods of all: the parents of their classes."""
