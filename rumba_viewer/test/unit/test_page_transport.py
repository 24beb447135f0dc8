"""What no browser and no library sends: requests with bodies, broken frames, dates that no calendar knows."""

import struct

import pytest
from served_pages import CLOSE, GREETING, TEXT, Page, answer, frame, is_served, listener, run


@pytest.mark.parametrize('request_line', ['POST / HTTP/1.1', 'GET / HTTP/1.1', 'PUT /app.js HTTP/1.0'])
@pytest.mark.parametrize('body', [
    'Transfer-Encoding: chunked\r\n\r\n-5\r\n', 'Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n',
    'Transfer-Encoding: gzip\r\n\r\n', 'Content-Length: 5\r\n\r\nhello', 'Content-Length: -5\r\n\r\n',
    'Content-Length: x\r\n\r\n', 'Content-Length: 5\r\nContent-Length: 6\r\n\r\nhello',
    'Content-Length: 99999999999\r\nExpect: 100-continue\r\n\r\n',
    'Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n-5\r\n'])
def test_a_request_with_a_body_is_refused_before_the_body_is_read(request_line, body):
    async def act():
        page = Page()
        good = await listener(page)
        told = await answer(page, f'{request_line}\r\nHost: localhost\r\n{body}'.encode())
        assert told.startswith(b'HTTP/1.1 413 ') and told.endswith(b'takes no requests with a body.\n')
        await is_served(page, good)
    run(act)


def test_a_request_after_one_that_announces_an_empty_body_is_answered():
    async def act():
        request = 'GET /style.css HTTP/1.1\r\nHost: localhost\r\n'
        told = await answer(Page(), f'{request}Content-Length: 0\r\n\r\n{request}Connection: close\r\n\r\n'.encode())
        assert told.count(b'HTTP/1.1 200 OK') == 2
    run(act)


@pytest.mark.parametrize('date', ['Mon, 01 Jan 99999 00:00:00 GMT', 'Mon, 01 Jan 0 99:99:99 GMT', 'x'])
def test_a_date_that_no_calendar_knows_gets_the_file(date):
    async def act():
        told = await answer(Page(), b'GET /style.css HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n'
                            + f'If-Modified-Since: {date}\r\n\r\n'.encode())
        assert told.startswith(b'HTTP/1.1 200 OK')
    run(act)


def test_a_frame_without_a_mask_ends_its_own_client_with_a_status():
    async def act():
        page = Page()
        good = await listener(page)
        told = await answer(page, GREETING + frame(TEXT, b'{"op":"subscribe","topic":"/map"}', is_masked=False))
        assert b'a client must mask its frames: RFC 6455' in told
        assert struct.pack('!H', 1002) in told and len(page.hub.feeds['/map']._listeners) == 1
        await is_served(page, good)
    run(act)


def test_a_reason_of_a_close_that_is_no_text_ends_its_own_client_without_an_error_of_the_page(caplog):
    async def act():
        page = Page()
        good = await listener(page)
        assert (await answer(page, GREETING + frame(CLOSE, b'\x03\xe8\xff'))).startswith(b'HTTP/1.1 101 ')
        await is_served(page, good)
    run(act)
    assert not caplog.records
