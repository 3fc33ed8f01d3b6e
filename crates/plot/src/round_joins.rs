//! Pixels whose lines have round joins: the backend of plotters joins wide lines with mitres, which at a sharp corner
//! are spikes far beyond the data.

use plotters::prelude::{BitMapBackend, DrawingBackend};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingErrorKind};

/// The backend of pixels, but for its lines: what is not forwarded here is made of what is.
pub(super) struct RoundJoins<'a> {
    pub(super) pixels: BitMapBackend<'a>,
    /// Asked at each straight piece of a wide line; false ends the drawing with an error.
    pub(super) keep_going: &'a dyn Fn() -> bool,
}

type Drawn<'a> = Result<(), DrawingErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

impl<'a> DrawingBackend for RoundJoins<'a> {
    type ErrorType = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.pixels.get_size()
    }

    fn ensure_prepared(&mut self) -> Drawn<'a> {
        self.pixels.ensure_prepared()
    }

    fn present(&mut self) -> Drawn<'a> {
        self.pixels.present()
    }

    fn draw_pixel(&mut self, point: BackendCoord, colour: BackendColor) -> Drawn<'a> {
        self.pixels.draw_pixel(point, colour)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn<'a> {
        self.pixels.draw_line(from, to, style)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn<'a> {
        let width = style.stroke_width();
        // What is thin has no joins that can be seen, and where colours mix each pixel may be drawn only once.
        if width < 3 || style.color().alpha < 1.0 {
            return self.pixels.draw_path(path, style);
        }
        let mut last: Option<BackendCoord> = None;
        for point in path {
            if last == Some(point) {
                continue;
            }
            if !(self.keep_going)() {
                // The errors of that backend itself cannot be made here.
                return Err(DrawingErrorKind::FontError("the drawing was ended".into()));
            }
            if let Some(from) = last {
                self.pixels.draw_path([from, point], style)?;
            }
            self.pixels.draw_circle(point, width / 2, &style.color(), true)?;
            last = Some(point);
        }
        Ok(())
    }
}
