"""Training the posture-blending network: the one part of the project that needs torch.

`networks` holds both variants, `losses` what they are judged by in training, `training` the loop
with its checkpoints, `export` the way to the ONNX file that ships. Features and pairs come from
`stridewire_engine.networks.blend`, the very code that serves.
"""
