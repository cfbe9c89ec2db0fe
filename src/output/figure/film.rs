//! The frames of a film: figures of states in one view and on one scale, each sheet in the middle.

use super::projection::Projection;
use super::sheet::{FigureFrame, FigureShape, Pen, ROOM, shapes};
use crate::math::{Vec3, bounds};
use crate::output::Picture;

/// The view that all frames of a film share.
pub(crate) struct FilmView {
    view: Projection,
    frame: FigureFrame,
    pen: Pen,
}

impl FilmView {
    /// Returns the view in which one of the states is seen as in its figure, on the scale at which all states fit into
    /// the frame, with the line widths of the sharpest fold of all; `None` if there is no such state.
    pub(crate) fn of(pictures: &[Picture], front: usize) -> Option<Self> {
        let front = pictures.get(front)?;
        let view = Projection::of(&front.points, &front.triangles);
        let placed: Vec<Vec<Vec3>> = pictures.iter().map(|picture| placed(&view, picture)).collect();
        let frame = FigureFrame::around(placed.iter().flatten(), ROOM);
        let pens: Vec<Pen> =
            pictures.iter().zip(&placed).map(|(picture, sheet)| Pen::new(picture, &frame, sheet)).collect();
        let sharpest = pens.iter().map(|pen| pen.sharpest).fold(0.0, f64::max);
        Some(Self { pen: Pen { sharpest, unit: pens[0].unit }, view, frame })
    }

    /// Returns the height of a frame; its width is that of every figure.
    pub(crate) fn height(&self) -> f64 {
        self.frame.height
    }

    /// Returns the faces and edges of a state from back to front.
    pub(crate) fn shapes(&self, picture: &Picture) -> Vec<FigureShape> {
        shapes(picture, &self.frame, &self.view, &self.pen, &placed(&self.view, picture))
    }
}

/// Returns the points of a state as the projection places them, about the middle of their box.
fn placed(view: &Projection, picture: &Picture) -> Vec<Vec3> {
    let places: Vec<Vec3> = picture.points.iter().map(|point| Vec3::from(view.place(point))).collect();
    let finite = places.iter().filter(|place| place.iter().all(|x| x.is_finite()));
    let [low, high] = bounds(finite);
    places.iter().map(|place| place - (low * 0.5 + high * 0.5)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    /// Claim: a sheet stays in the middle of the film and keeps its scale: a state that is another one moved away has
    /// the same frame. Tolerance: a tenth of the last digit of a drawing.
    #[test]
    fn the_sheet_stays_in_the_middle() {
        let near = samples::hinge(0.4);
        let mut far = near.clone();
        far.points.iter_mut().for_each(|point| *point += Vec3::new(3.0, -2.0, 7.0));
        let film = FilmView::of(&[near.clone(), far.clone(), samples::hinge(1.5)], 0).unwrap();
        let places = |picture| film.shapes(picture).into_iter().flat_map(|shape| shape.places).collect::<Vec<_>>();
        let off =
            places(&near).into_iter().zip(places(&far)).map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()));
        assert!(off.fold(0.0, f64::max) <= 0.01);
        assert!(places(&near).len() == places(&far).len() && film.height() > 2.0 * ROOM);
        assert!(FilmView::of(&[], 0).is_none());
        let empty = FilmView::of(&[Picture::default()], 0).unwrap();
        assert!(empty.shapes(&Picture::default()).is_empty());
    }
}
