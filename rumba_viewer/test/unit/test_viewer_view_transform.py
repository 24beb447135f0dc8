"""From the map to the picture and back."""

import pytest
from pytest import approx

from rumba_viewer.scene.snapshot import Box
from rumba_viewer.scene.view_transform import MARGIN, SCALES, ViewTransform

BOX = Box(-1.0, 2.0, 3.0, 5.0)
VIEW = ViewTransform(400.0, 300.0, 1.0, 3.5, 100.0)


def test_x_goes_to_the_right_and_y_upward():
    assert VIEW.to_pixel(-1.0, 2.0) == (0.0, 300.0)
    assert VIEW.to_pixel(3.0, 5.0) == (400.0, 0.0)
    assert VIEW.to_pixel(2.0, 3.5) == (300.0, 150.0)
    assert VIEW.to_map(300.0, 50.0) == approx((2.0, 4.5))


@pytest.mark.parametrize('width, height, scale', [
    (400.0 + 2 * MARGIN, 500.0, 100.0), (900.0, 300.0 + 2 * MARGIN, 100.0), (200.0 + 2 * MARGIN, 500.0, 50.0)])
def test_a_fitted_map_fills_the_picture_in_one_direction_and_is_centred(width, height, scale):
    view = ViewTransform.fitted(BOX, width, height)
    assert view.scale == approx(scale)
    assert view.to_pixel(1.0, 3.5) == approx((0.5 * width, 0.5 * height))


def test_rows_above_and_below_the_map_are_left_free():
    view = ViewTransform.fitted(BOX, 400.0, 300.0, 50.0, 100.0)
    rows = [view.to_pixel(BOX.left, y)[1] for y in (BOX.top, BOX.bottom)]
    assert rows[0] >= 50.0 + 13.9 and rows[1] <= 200.0 - 13.9 and sum(rows) / 2.0 == approx(125.0)


@pytest.mark.parametrize('box, width, height', [(Box(1.0, 1.0, 1.0, 1.0), 100.0, 100.0), (BOX, 1.0, 1.0)])
def test_a_map_or_picture_without_size_can_be_fitted(box, width, height):
    assert ViewTransform.fitted(box, width, height).scale > 0.0


@pytest.mark.parametrize('factor', [1.5, 0.6])
def test_zooming_keeps_the_point_under_the_mouse(factor):
    zoomed = VIEW.zoomed(factor, 350.0, 40.0)
    assert zoomed.scale == approx(100.0 * factor)
    assert zoomed.to_map(350.0, 40.0) == approx(VIEW.to_map(350.0, 40.0))


@pytest.mark.parametrize('factor, scale', [(1e-6, SCALES[0]), (1e6, SCALES[1])])
def test_zooming_has_limits(factor, scale):
    zoomed = VIEW.zoomed(factor, 10.0, 10.0)
    assert zoomed.scale == scale
    assert zoomed.to_map(10.0, 10.0) == approx(VIEW.to_map(10.0, 10.0))


def test_a_map_that_is_too_large_for_the_least_scale_can_be_zoomed():
    view = ViewTransform.fitted(Box(0.0, 0.0, 10_000.0, 10.0), 400.0, 300.0)
    assert view.zoomed(1.2, 0.0, 0.0).scale == approx(1.2 * view.scale)


def test_panning_moves_the_map_with_the_mouse():
    x, y = VIEW.to_pixel(2.0, 3.0)
    assert VIEW.panned(30.0, -20.0).to_pixel(2.0, 3.0) == approx((x + 30.0, y - 20.0))


def test_resizing_keeps_the_centre_and_the_scale():
    resized = VIEW.resized(600.0, 200.0)
    assert (resized.scale, resized.to_map(300.0, 100.0)) == (100.0, approx((1.0, 3.5)))
