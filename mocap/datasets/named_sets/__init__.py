"""Sets of clips that other labs share: Bandai-Namco, LAFAN1, 100STYLE, each under a licence of its own.

A copy of your own in the folder that the environment variable `MOCAP_DATA` names is read first; what is
missing is downloaded once. Each fetched clip's SHA-256 is kept in the file `SHA256SUMS` beside it, so a clip
that changes later, here or at its source, is refused.

Reading order
-------------
1. `known_sets`: licences, addresses, and which joints are hips and legs
2. `resumed_downloads`: a download that goes on where it broke off
3. `unpacked_clips`: the clips of an archive, and their checksums
4. `set_clips`: fetch a set, list its clips, read one
"""
