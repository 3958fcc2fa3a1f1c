"""The programs here are for `test_types.py`: to collect them would run them."""

collect_ignore_glob = ["*_calls.py"]
