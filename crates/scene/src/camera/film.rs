//! The film's plane: pixels, and where they show the same.

use caustica_math::Vec2;

use crate::description::{Description, FilmSettings, Filter};
use crate::diagnostic::Diagnostic;

/// The size of the full picture in pixels, and the place on it where the camera looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Film {
    pub width: f32,
    pub height: f32,
    pub center: Vec2,
}

impl Film {
    /// `principal_point` is in shares of the picture.
    pub fn new(film: &FilmSettings, [x, y]: [f32; 2]) -> Result<Self, &'static str> {
        let (width, height) = (film.width as f32, film.height as f32);
        if x.abs().max(y.abs()) <= FARTHEST_SHIFT {
            Ok(Self { width, height, center: Vec2::new(x * width, y * height) })
        } else {
            Err("the camera's principal point must lie within a thousand pictures of its picture")
        }
    }

    /// A film position to the plane z = 1 (or, for parallel projection, the plane of the film).
    pub fn to_plane(self, film: Vec2, pixel: f32) -> Vec2 {
        Vec2::new((self.center.x - film.x) * pixel, (self.center.y - film.y) * pixel)
    }

    /// The inverse of `to_plane`.
    pub fn of_plane(self, x: f32, y: f32, pixel: f32) -> Vec2 {
        Vec2::new(self.center.x - x / pixel, self.center.y - y / pixel)
    }

    /// The largest distance of the film's corners from the place where the camera looks, by axis.
    pub fn reach(self) -> [f32; 2] {
        let side = |center: f32, size: f32| center.abs().max((size - center).abs());
        [side(self.center.x, self.width), side(self.center.y, self.height)]
    }

    /// A position and, if the picture goes all `around`, those beyond its seams that show the same.
    pub fn seams(self, film: Vec2, margin: f32, around: bool) -> impl Iterator<Item = Vec2> + use<> {
        let (w, h) = (self.width, self.height);
        let rows = [film.y, -film.y, 2.0 * h - film.y];
        let columns = [0.0, w, -w, 0.5 * w, -0.5 * w, 1.5 * w];
        let inside =
            move |p: &Vec2| p.x >= -margin && p.x <= w + margin && p.y >= -margin && p.y <= h + margin;
        let candidates = rows.into_iter().enumerate().flat_map(move |(r, y)| {
            columns.into_iter().enumerate().filter_map(move |(c, dx)| {
                // Across a pole the picture continues half a turn away.
                let same = (r == 0 && c < 3) || (r > 0 && c >= 3);
                (same && (around || (r == 0 && c == 0))).then(|| Vec2::new(film.x + dx, y))
            })
        });
        candidates.filter(inside)
    }

    /// The same place of every pixel, if `wanted`.
    pub fn tiles(self, film: Vec2, wanted: bool) -> impl Iterator<Item = Vec2> + use<> {
        let (columns, rows) = if wanted { (self.width as u32, self.height as u32) } else { (1, 0) };
        let within = Vec2::new(film.x - film.x.floor(), film.y - film.y.floor());
        (0..columns * rows)
            .map(move |i| Vec2::new((i % columns) as f32 + within.x, (i / columns) as f32 + within.y))
    }
}

/// In sizes of the picture. Beyond, pixels could not be told apart by their places.
const FARTHEST_SHIFT: f32 = 1e3;

/// The film. A meter's has no use for a filter: all pixels show the same.
pub(crate) fn film_settings(description: &Description, warnings: &mut Vec<Diagnostic>) -> FilmSettings {
    let (mut film, pixel) = (description.film.clone(), Filter::Box { radius: 0.5 });
    if description.camera.kind.is_meter() && film.filter != pixel {
        film.filter = pixel;
        let message = "a meter has no use for a pixel filter: each pixel is measured by itself";
        warnings.push(Diagnostic::warning(message).at(description.camera.origin.clone()));
    }
    film
}
