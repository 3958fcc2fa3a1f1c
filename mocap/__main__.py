"""`python -m mocap` is the command `mocap`; both enter here, before anything that takes a while to load."""

import sys


def main() -> int:
    """Run the command and return its exit status: also 130 for Ctrl-C while the package is loaded."""
    try:
        from mocap.cli.main import main as run  # Ctrl-C may come while this is imported

        return run()
    except KeyboardInterrupt:
        print("mocap: interrupted before anything was done.", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
