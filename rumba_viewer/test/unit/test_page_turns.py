"""Who may use how much of the page, and whose turn it is, by a clock that the test sets."""

import pytest

from rumba_viewer.page.turns import AT_ONCE, OF_CLIENTS, Account, Bucket, Limit, Turns

CPU = Limit(0.05, 0.1, 0.1, '5 % of a core')


class Time:
    """A clock, and what is to be done later."""

    def __init__(self):
        self.now, self._plans = 0.0, []

    def later(self, seconds, act):
        self._plans.append((self.now + (max(seconds, 1e-6) if seconds else 0.0), act))  # rounding must not stop time

    def run(self, until):
        """Do what is due, in its order, up to a time."""
        while True:
            due = min((plan for plan in self._plans if plan[0] <= until), key=lambda plan: plan[0], default=None)
            if due is None:
                break
            self._plans.remove(due)
            self.now = max(self.now, due[0])
            due[1]()
        self.now = until


class Worker:
    """A client that always has work, each piece of which costs so much CPU time."""

    def __init__(self, time, turns, cost):
        self.account, self.times = Account(time.now, CPU), []
        self._time, self._turns, self._cost = time, turns, cost
        turns.ask(self.account, self._work)

    def _work(self):
        self.times.append(self._time.now)
        self._turns.pay(self.account, self._cost)
        self._turns.ask(self.account, self._work)


def test_a_bucket_fills_at_its_rate_and_whoever_takes_more_waits():
    bucket = Bucket(2.0, 4.0, 10.0, 3.0)
    assert [bucket.takes(10.0) for _ in range(4)] == [True, True, True, False]
    assert bucket.wait(10.0) == pytest.approx(0.5) and bucket.wait(10.5) == 0.0
    assert bucket.left(100.0) == 4.0


def test_an_account_waits_for_the_limit_that_is_exceeded_most_and_names_it():
    account = Account(0.0, CPU, elements=Limit(100.0, 100.0, 100.0, '100 values in a second'))
    account.pay(0.0, 0.105, elements=150.0)
    assert account.wait(0.0) == pytest.approx(0.5) and account.bound(0.0) == '100 values in a second'
    account.pay(0.0, 0.045)
    assert account.wait(0.0) == pytest.approx(1.0) and account.bound(0.0) == '5 % of a core'


def test_each_gets_its_share_and_all_together_no_more_than_theirs():
    time = Time()
    turns = Turns(lambda: time.now, time.later)
    one = Worker(time, turns, 0.01)
    time.run(100.0)
    assert 0.01 * len(one.times) == pytest.approx(100.0 * CPU.rate + CPU.most, abs=0.02)
    crowd = [one, *(Worker(time, turns, 0.01) for _ in range(39))]
    time.run(200.0)
    counts = [sum(moment > 100.0 for moment in worker.times) for worker in crowd]
    assert 0.01 * sum(counts) == pytest.approx(100.0 * OF_CLIENTS + AT_ONCE, abs=0.05)
    assert min(counts) > 0.8 * max(counts)


def test_whoever_used_little_is_next_however_many_others_wait():
    time = Time()
    turns = Turns(lambda: time.now, time.later)
    for _ in range(50):
        Worker(time, turns, 0.01)
    time.run(20.0)
    quiet, begun = Account(time.now, CPU), []
    turns.ask(quiet, lambda: begun.append(time.now))
    time.run(30.0)
    assert begun[0] - 20.0 <= 0.01 / OF_CLIENTS + 1e-9  # what the one before it used of all


def test_a_newcomer_does_not_wait_until_somebody_in_debt_may_go_on():
    time = Time()
    turns = Turns(lambda: time.now, time.later)
    debtor, begun = Account(time.now, CPU), []
    debtor.pay(0.0, 10.0)
    turns.ask(debtor, lambda: begun.append('debtor'))
    time.run(1.0)
    turns.ask(Account(time.now, CPU), lambda: begun.append('newcomer'))
    time.run(1.1)
    assert begun == ['newcomer']
    time.run(200.0)
    assert begun == ['newcomer', 'debtor']


def test_clients_do_not_wait_until_new_connections_are_paid_for_nor_these_for_clients():
    time = Time()
    turns, begun = Turns(lambda: time.now, time.later), []
    client, address = Account(0.0, CPU), Account(0.0, CPU, is_client=False)
    turns.pay(address, 10.0)
    turns.ask(client, lambda: begun.append('client'))
    turns.ask(address, lambda: begun.append('address'))
    time.run(1e-3)
    assert begun == ['client'] and turns.pause() > 10.0
    turns.pay(Account(0.0, CPU), 1000.0)
    turns.ask(client, lambda: begun.append('client'))
    time.run(300.0)
    assert begun == ['client', 'address']


def test_whoever_used_more_while_waiting_goes_behind_others():
    time = Time()
    turns, order = Turns(lambda: time.now, time.later), []
    used, fresh = Account(0.0, CPU), Account(0.0, CPU, used=0.01)
    turns.ask(used, lambda: order.append('used'))
    turns.ask(fresh, lambda: order.append('fresh'))
    turns.pay(used, 0.015)
    time.run(1.0)
    assert order == ['fresh', 'used']


def test_what_looks_is_not_multiplied_by_waits_that_end_early():
    time = Time()
    turns = Turns(lambda: time.now, time.later)
    looks = []
    later, turns._later = turns._later, lambda *plan: (looks.append(plan), later(*plan))
    debtor, quiet = Account(0.0, CPU), Account(0.0, CPU)
    debtor.pay(0.0, 1.0)
    turns.ask(debtor, lambda: None)
    for number in range(100):
        turns.ask(quiet, lambda: None)
        time.run(0.01 * (number + 1))
    time.run(30.0)
    assert len(looks) <= 2 * 100 + 2


def test_whoever_has_left_waits_no_longer():
    time = Time()
    turns, begun = Turns(lambda: time.now, time.later), []
    debtor = Account(0.0, CPU)
    debtor.pay(0.0, 10.0)
    for number in range(2):
        turns.ask(debtor, lambda number=number: begun.append(number))
    turns.release(debtor)
    assert begun == [0, 1]
    time.run(300.0)
    assert begun == [0, 1]
