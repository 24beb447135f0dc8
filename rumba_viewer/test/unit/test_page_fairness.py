"""Who gives way if the clients of the page listen to too many topics, or are too many."""

import pytest
from served_pages import Page, is_told_and_ended, run

from rumba_viewer.page.addresses import Address
from rumba_viewer.page.allow_list import Rights, Tokens
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages.errors import Refusal


class Client:
    """One that listens."""

    def __init__(self, hub, address, *topics):
        self.address, self.lost, self._hub = address, [], hub
        for topic in topics:
            self.listen(topic)

    def listen(self, topic):
        self._hub.listen(self, topic, '', Demand(name=topic))

    def lose(self, topic):
        self.lost.append(topic)
        self._hub.feeds[topic].remove(self)


def test_whoever_listens_to_most_topics_gives_one_up_for_whoever_listens_to_less():
    async def act():
        hub, here, there = Page().hub, Address('here', 0.0), Address('there', 0.0)
        greedy = Client(hub, here, *(f'/greedy{number}' for number in range(5)), '/shared')
        modest = Client(hub, here, '/modest0', '/modest1', '/modest2', '/shared')
        other = Client(hub, there, *(f'/other{number}' for number in range(7)))
        assert hub.topic_to_give_up(modest).startswith('/greedy') and greedy.lost == ['/greedy0']
        assert hub.topic_to_give_up(modest) == '/greedy0'  # to which nobody listens any more
        del hub.feeds['/greedy0']
        with pytest.raises(Refusal, match='this page listens to 1000 topics already, 4 of them for you'):
            hub.topic_to_give_up(modest)
        assert hub.topic_to_give_up(other).startswith('/greedy') and not modest.lost and not other.lost
    run(act)


def test_a_client_with_a_token_takes_the_place_of_one_that_can_only_watch():
    async def act():
        page = Page(Tokens('secret'), connections=3)
        watching = [await page.open() for _ in range(3)]
        driving = await page.open('?token=secret')
        await is_told_and_ended(watching[-1], 'has 3 clients already, and another one came')
        await is_told_and_ended(await page.open(), 'has 3 clients already: close one')
        assert page.hub.clients == 3 and driving.protocol is not None
    run(act)


def test_a_watcher_from_where_many_come_gives_way_to_one_from_elsewhere():
    async def act():
        page = Page(Tokens('secret'), connections=3)
        watching = [await page.open() for _ in range(3)]
        newcomer = Client(page.hub, Address('elsewhere', 0.0))
        page.hub.enter(newcomer, Rights())
        await is_told_and_ended(watching[-1], 'and another one came')
        with pytest.raises(Refusal, match='has 3 clients already'):
            page.hub.enter(Client(page.hub, newcomer.address), Rights())
        assert page.hub.clients == 3
    run(act)
