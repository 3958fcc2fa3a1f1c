"""`python -m mocap` is the command `mocap`."""

import sys

from mocap.cli.main import main

sys.exit(main())
