"""One Animate stream: what comes in, what goes out, and when."""
