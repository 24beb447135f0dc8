"""What the whole model uses: errors, files that users name, settings, names, angles and poses."""
