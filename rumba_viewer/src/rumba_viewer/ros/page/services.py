"""Calls services in threads, so that the page waits for none of them."""

import concurrent.futures
from typing import Any, Callable

import rospy
import rosservice

from rumba_sim.model.errors import one_line
from rumba_viewer.page import conversion
from rumba_viewer.page.errors import Refusal
from rumba_viewer.page.protocol import API
from rumba_viewer.ros.page.graph import Graph

THREADS = 8
MOST = 64  # calls that wait for an answer, of all clients


class Services:
    """Calls services. Its method is called in the thread of the loop, and never blocks."""

    def __init__(self, graph: Graph, filler: conversion.Filler, later: Callable[..., Any]) -> None:
        """Fill requests by `filler`; call functions in the loop `later`, after a time [s]."""
        self._graph, self._filler, self._later = graph, filler, later
        self._executor = concurrent.futures.ThreadPoolExecutor(THREADS)
        self._open = 0

    def call(self, service: str, values: Any, done: Callable[[bool, Any], None]) -> None:
        """Call a service; `done` gets the answer, in the thread of the loop.

        Raises:
            Refusal: too many calls wait already.
        """
        if self._open >= MOST:
            raise Refusal(f'{service}: {MOST} calls of this page wait for an answer already')
        self._open += 1

        def on_answer(future: Any) -> None:
            error = future.exception()
            answer = (True, future.result()) if error is None else (False, _reason(service, error))
            self._later(0.0, lambda: self._answer(done, *answer))
        self._executor.submit(self._ask, service, values).add_done_callback(on_answer)

    def close(self) -> None:
        """Begin nothing more."""
        self._executor.shutdown(wait=False)

    def _answer(self, done: Callable[[bool, Any], None], worked: bool, values: Any) -> None:
        self._open -= 1
        done(worked, values)

    def _ask(self, service: str, values: Any) -> Any:
        if service.startswith(API):
            return self._graph.api(service[len(API):], values)
        kind = rosservice.get_service_class_by_name(service)
        request = kind._request_class()
        if isinstance(values, list):
            values = dict(zip(request.__slots__, values))
        answer = rospy.ServiceProxy(service, kind)(self._filler.fill(request, values or {}))
        return conversion.to_json(answer)


def _reason(service: str, error: BaseException) -> str:
    if isinstance(error, (Refusal, rospy.ServiceException, rosservice.ROSServiceException)):
        return one_line(f'{service}: {error}')
    return one_line(f'{service}: {type(error).__name__}: {error}')
