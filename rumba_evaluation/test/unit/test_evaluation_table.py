"""The tables have the values of the results."""

import math

from evaluations import case, result, steady

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials import table
from rumba_evaluation.trials.cases import grid

TABLE = '''\
Working time to coverage in multiples of T, median and worst of the runs; T: room 100 s (5.1 m2)
map   strategy  robots  runs         80 %         90 %         95 %         98 %         99 %  failed  outcomes
room  bounce         1     3   1.60  2.40   1.80  2.70   1.90  2.85   1.96  2.94   1.98     -       1  2 succeeded, \
1 fallen
room  bounce         2     1      -     -      -     -      -     -      -     -      -     -       1  1 timed out

Least coverage, medians of the runs, and runs in which a robot was in a wall
map   strategy  robots  least %  dirt %  distance m  turns  collisions  charges  Wh/m2  total s  in walls
room  bounce         1     98.5    10.0          50     12           3        2  0.300      200         1
room  bounce         2     99.0    10.0          40     12           3        0      -      150         0
'''
CASES = grid(['room'], ['bounce'], [1, 2, 3], [1, 2])
FOUND = {
    CASES[0]: steady(1.0, distance=50.0, time=200.0, charges=2),
    CASES[1]: steady(2.0, distance=60.0, time=300.0, charges=3),
    CASES[2]: steady(3.0, until=98, coverage=0.985, outcome=Outcome.FALLEN, penetrated=True),
    CASES[3]: result(energy_per_area=math.nan, outcome=Outcome.TIMED_OUT)}


def test_the_tables():
    assert table.text(table.grouped(CASES, FOUND)) == TABLE


def test_rows_are_in_the_order_of_the_cases_not_of_the_results():
    cases = grid(['b', 'a'], ['bounce', 'ahead'], [1], [1])
    groups = table.grouped(cases, {one: result() for one in reversed(cases)})
    assert [name[:2] for name in groups] == [('b', 'bounce'), ('b', 'ahead'), ('a', 'bounce'), ('a', 'ahead')]


def test_curves_have_a_row_for_each_percent(tmp_path):
    path = tmp_path / 'coverage.csv'
    table.write_curves(str(path), [case(), case(seed=2)], {case(): steady(1.5, until=2)})
    assert path.read_text() == '''\
map,strategy,seed,robots,percent,s,T
room,bounce,1,1,1,1.5,0.0150
room,bounce,1,1,2,3.0,0.0300
'''
