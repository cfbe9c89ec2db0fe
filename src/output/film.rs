//! Films of states: GIF by the crates `tiny-skia` and `gif`, MP4 by ffmpeg if that program is there.
//!
//! The frames are the figures of the states without text, in the same view and on the same scale. Equal data give equal
//! bytes of a GIF.

use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use gif::{Encoder, Frame, Repeat};
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

use super::figure::canvas::WIDTH;
use super::figure::film::FilmView;
use super::figure::palette::{Colour, PAPER};
use super::figure::sheet::{FigureShape, TILE};
use super::picture::Picture;
use super::{OutputError, files};
use crate::numerics::parallel::map_with_state;

/// Number of frames that are in memory at the same time.
const AT_ONCE: usize = 16;
/// Largest relation of height and width of a frame.
const HIGHEST: f64 = 2.0;
/// How coarsely colours are sampled when 256 of them are chosen for a frame, from 1 (all pixels) to 30.
const SAMPLING: i32 = 10;
/// Hundredths of a second in a second, the unit of time of a GIF.
const HUNDREDTHS: u16 = 100;

/// The width of a film in pixels, and its number of frames in a second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmOptions {
    /// Width in pixels.
    pub width: u16,
    /// Frames in a second; in a GIF, the nearest that whole hundredths of a second allow.
    pub frames_per_second: u16,
}

/// The states of a film in their order.
#[derive(Clone, Debug)]
pub(crate) struct Reel {
    /// A picture for each frame.
    pub pictures: Vec<Picture>,
    /// Number of the picture by which the view is chosen.
    pub front: usize,
}

/// The frames of a film before they are drawn.
struct Film<'a> {
    view: FilmView,
    pictures: &'a [Picture],
    columns: u16,
    rows: u16,
}

impl<'a> Film<'a> {
    fn new(Reel { pictures, front }: &'a Reel, width: u16) -> io::Result<Self> {
        let none = || io::Error::new(io::ErrorKind::InvalidData, "a film without states");
        let view = FilmView::of(pictures, *front).ok_or_else(none)?;
        // codecs of films take even numbers of pixels only
        let even = |length: f64| 2 * (length / 2.0).round().max(1.0) as u16;
        let height = f64::from(width) * (view.height() / WIDTH).min(HIGHEST);
        Ok(Self { view, pictures, columns: even(f64::from(width)), rows: even(height) })
    }

    /// Calls `take` with the red, green and blue parts of the pixels of each frame in order.
    fn frames(&self, mut take: impl FnMut(Vec<u8>) -> io::Result<()>) -> io::Result<()> {
        for part in self.pictures.chunks(AT_ONCE) {
            let drawn = map_with_state(part.len(), || (), |(), k| self.pixels(&self.view.shapes(&part[k])));
            drawn.into_iter().try_for_each(|pixels| take(pixels?))?;
        }
        Ok(())
    }

    fn pixels(&self, shapes: &[FigureShape]) -> io::Result<Vec<u8>> {
        let size = || io::Error::new(io::ErrorKind::InvalidData, "a frame of this size cannot be drawn");
        let mut map = Pixmap::new(self.columns.into(), self.rows.into()).ok_or_else(size)?;
        let Colour(red, green, blue) = PAPER;
        map.fill(Color::from_rgba8(red, green, blue, u8::MAX));
        let scale = Transform::from_scale(
            (f64::from(self.columns) / WIDTH) as f32,
            (f64::from(self.rows) / self.view.height()) as f32,
        );
        shapes.iter().for_each(|shape| paint(&mut map, shape, scale));
        Ok(map.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect())
    }
}

fn paint(map: &mut Pixmap, FigureShape { places, closed, style }: &FigureShape, scale: Transform) {
    let mut builder = PathBuilder::new();
    for (k, [x, y]) in places.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if k == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    if *closed {
        builder.close();
    }
    let Some(path) = builder.finish() else { return };
    let ink = |Colour(red, green, blue): Colour| {
        let mut paint = Paint::default();
        let opacity = style.opacity.unwrap_or(1.0) * f64::from(u8::MAX);
        paint.set_color_rgba8(red, green, blue, opacity.round() as u8);
        paint
    };
    if let Some(colour) = style.fill {
        map.fill_path(&path, &ink(colour), FillRule::Winding, scale, None);
    }
    if let Some((colour, width)) = style.stroke {
        let width = if width > 0.0 { width } else { TILE } as f32;
        let dash = style.dash.and_then(|dash| StrokeDash::new(dash.map(|length| length as f32).to_vec(), 0.0));
        let stroke = Stroke { width, dash, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
        map.stroke_path(&path, &ink(colour), &stroke, scale, None);
    }
}

/// Writes a GIF that starts anew after its last frame.
pub(crate) fn write_gif(path: &Path, reel: &Reel, options: FilmOptions) -> Result<(), OutputError> {
    files::write_with(path, |file| gif(file, reel, options))
}

fn gif(file: &mut dyn Write, reel: &Reel, options: FilmOptions) -> io::Result<()> {
    let film = Film::new(reel, options.width)?;
    let mut encoder = Encoder::new(file, film.columns, film.rows, &[]).map_err(io::Error::other)?;
    encoder.set_repeat(Repeat::Infinite).map_err(io::Error::other)?;
    let delay = (f64::from(HUNDREDTHS) / f64::from(options.frames_per_second)).round() as u16;
    film.frames(|pixels| {
        let frame = Frame::from_rgb_speed(film.columns, film.rows, &pixels, SAMPLING);
        encoder.write_frame(&Frame { delay, ..frame }).map_err(io::Error::other)
    })
}

/// Writes an MP4 (H.264) by the program `ffmpeg`.
pub(crate) fn write_mp4(path: &Path, reel: &Reel, options: FilmOptions) -> Result<(), OutputError> {
    let bytes = mp4(reel, options).map_err(|source| OutputError::Write { path: path.into(), source })?;
    files::write(path, bytes)
}

fn mp4(reel: &Reel, options: FilmOptions) -> io::Result<Vec<u8>> {
    let film = Film::new(reel, options.width)?;
    let folder = tempfile::tempdir()?;
    let made = folder.path().join("film.mp4");
    let (size, rate) = (format!("{}x{}", film.columns, film.rows), options.frames_per_second.to_string());
    let mut ffmpeg = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "-"])
        .args(["-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .arg(&made)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let mut sink = ffmpeg.stdin.take();
    let sent = film.frames(|pixels| sink.as_mut().map_or(Ok(()), |sink| sink.write_all(&pixels)));
    drop(sink);
    let done = ffmpeg.wait_with_output()?;
    if done.status.success() {
        sent.and_then(|()| std::fs::read(made))
    } else {
        // not the failure to write into a pipe that ffmpeg has closed, but its own words
        Err(io::Error::other(format!("ffmpeg: {}", String::from_utf8_lossy(&done.stderr).trim())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    const SMALL: FilmOptions = FilmOptions { width: 120, frames_per_second: 10 };

    fn reel(pictures: Vec<Picture>) -> Reel {
        Reel { pictures, front: 0 }
    }

    fn states() -> Reel {
        reel([0.2, 0.6, 1.0, 1.4].map(samples::hinge).to_vec())
    }

    fn decoded(bytes: &[u8]) -> (u16, u16, Vec<(u16, Vec<u8>)>) {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut reader = options.read_info(bytes).unwrap();
        let size = (reader.width(), reader.height());
        let mut frames = Vec::new();
        while let Some(frame) = reader.read_next_frame().unwrap() {
            frames.push((frame.delay, frame.buffer.to_vec()));
        }
        (size.0, size.1, frames)
    }

    /// Claim: a GIF has a frame for each state, of the width and the pace that were asked for, with the sheet on it,
    /// and no two different states have the same frame; equal states give equal bytes.
    #[test]
    fn a_frame_for_each_state() {
        let mut bytes = Vec::new();
        gif(&mut bytes, &states(), SMALL).unwrap();
        let (width, height, frames) = decoded(&bytes);
        assert_eq!((width, frames.len()), (120, 4));
        assert!(height > 20 && height % 2 == 0);
        assert!(frames.iter().all(|(delay, pixels)| *delay == 10 && pixels.len() == 4 * 120 * usize::from(height)));
        for (k, (_, pixels)) in frames.iter().enumerate() {
            let paper = &pixels[..4];
            let part = pixels.chunks(4).filter(|pixel| *pixel != paper).count();
            assert!(part * 10 > pixels.len() / 4, "{part} pixels of frame {k}");
            assert!(frames[..k].iter().all(|(_, other)| other != pixels));
        }
        let mut again = Vec::new();
        gif(&mut again, &states(), SMALL).unwrap();
        assert!(bytes == again);
    }

    /// Claim: a film of nothing is an error, and states whose points are not finite, or that have none, are frames
    /// without a sheet.
    #[test]
    fn films_of_nothing() {
        assert!(gif(&mut Vec::new(), &reel(vec![]), SMALL).is_err());
        let mut wild = samples::hinge(0.5);
        wild.points[3].x = f64::NAN;
        for pictures in [vec![Picture::default()], vec![wild, Picture::default()]] {
            let mut bytes = Vec::new();
            let count = pictures.len();
            gif(&mut bytes, &reel(pictures), SMALL).unwrap();
            assert_eq!(decoded(&bytes).2.len(), count);
        }
    }
}
