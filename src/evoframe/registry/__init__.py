"""The plugins of this process: how they are found, what they offer, who observes."""
