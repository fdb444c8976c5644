"""From a play to a plan: when each foot leaves and lands, where, and how it is turned. One rule to a module."""
