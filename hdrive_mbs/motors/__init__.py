"""Motor characteristics, one file each.  A user's own subclasses MotorCharacteristic."""
