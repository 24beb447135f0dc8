"""Python imports this first if the folder is on its path: plants the fault that an environment variable names."""

import os
import sys

FAULT = os.environ.get('RUMBA_PLANTED_FAULT')

if FAULT and sys.argv and os.path.basename(sys.argv[0]) == os.environ['RUMBA_PLANTED_IN']:
    import planting
    planting.plant(FAULT)
