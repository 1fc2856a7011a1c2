"""What a joint can do: a test motion that goes beyond its limits step by step, and what is read from it."""
