"""Networks: the feature code of each, and the session that runs it.

One folder a network. Training imports the same feature code, so features exist once; nothing here
needs torch.
"""
