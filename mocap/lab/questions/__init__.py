"""Questions in the page of a notebook, which mark themselves and keep what the reader thought.

A notebook names a question by the notebook's number and the question's name, such as
`lab.quiz("05-more-edges")`; its text stands in `texts/05-motion-graph.toml`. The output of the cell holds all
that a browser needs, so a question works without Python and without a network. Without a script, such as in
print, only what is asked is seen.

Reading order
-------------
1. `reading`: the questions of a notebook, as its file has them
2. `computed`: numbers in them that the notebook computes
3. `page`: what a question shows in a browser, and where no script runs
4. `quizzes`: a question with an answer and hints
5. `kept_bets`: what a reader thought before the answer, and what came out
"""
