"""The services of the contract: one thin file each that decodes, asks the runtime and encodes."""
