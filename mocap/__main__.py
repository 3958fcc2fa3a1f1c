"""Entry point of the command `mocap` and of `python -m mocap`, before any import that takes time."""

import sys


def main() -> int:
    """Run the command and return its exit status, which is 130 for Ctrl-C while the package is imported."""
    try:
        from mocap.cli.main import main as run  # Ctrl-C may come while this is imported

        return run()
    except KeyboardInterrupt:
        print("mocap: interrupted before anything was done.", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
