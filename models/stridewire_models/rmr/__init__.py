"""Training of the recurrent motion refiner.

Pairs, features and what the network's numbers mean are `stridewire_engine.networks.rmr`'s.
"""
