//! Pictures to compare, and what can be wrong with them.

use caustica_math::Rgb;

/// Why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MetricsError {
    /// A picture without pixels.
    #[error("a picture of {width} × {height} pixels has nothing to compare")]
    Empty {
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
    },
    /// The number of pixels is not width times height.
    #[error("a picture of {width} × {height} pixels cannot be made of {found} pixels")]
    PixelCount {
        /// The width told.
        width: u32,
        /// The height told.
        height: u32,
        /// The number of pixels given.
        found: usize,
    },
    /// The picture and its reference differ in size.
    #[error(
        "the picture has {}×{} pixels and its reference {}×{}; render both in the same resolution",
        image.0, image.1, reference.0, reference.1
    )]
    Sizes {
        /// Width and height of the picture.
        image: (u32, u32),
        /// Width and height of the reference.
        reference: (u32, u32),
    },
    /// The reference has a pixel that is infinite or not a number.
    #[error("the reference is not finite at ({x}, {y}): nothing can be compared with it")]
    BadReference {
        /// Column of the first such pixel.
        x: u32,
        /// Its row, from the top.
        y: u32,
    },
    /// HDR-ꟻLIP takes its exposures from the reference's luminance, and there is none.
    #[error("the reference is black, so that no exposure fits it; give the first and the last exposure")]
    BlackReference,
    /// Exposures that are not finite, in the wrong order, or too few or too many.
    #[error(
        "{count} exposures from {start} to {stop} stops are not possible: the first must not be above the last, and \
         there must be 1 to {} of them, 2 or more where the two differ",
        crate::flip::MAX_EXPOSURES
    )]
    Exposures {
        /// The first exposure in stops.
        start: f32,
        /// The last exposure in stops.
        stop: f32,
        /// The number of exposures.
        count: u32,
    },
    /// Pixels per degree outside of what the filters are made for.
    #[error(
        "{0} pixels per degree are not possible; a desk's display has about 67, and 1 to 1000 can be had"
    )]
    PixelsPerDegree(f32),
}

/// A picture in linear Rec. 709 light, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a> {
    width: u32,
    height: u32,
    pixels: &'a [Rgb],
}

impl<'a> Image<'a> {
    /// A picture of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`MetricsError::Empty`] for a side of zero, [`MetricsError::PixelCount`] for another number of
    /// `pixels`.
    pub fn new(width: u32, height: u32, pixels: &'a [Rgb]) -> Result<Self, MetricsError> {
        if width == 0 || height == 0 {
            return Err(MetricsError::Empty { width, height });
        }
        if u64::from(width) * u64::from(height) != pixels.len() as u64 {
            return Err(MetricsError::PixelCount { width, height, found: pixels.len() });
        }
        Ok(Self { width, height, pixels })
    }

    /// The width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &'a [Rgb] {
        self.pixels
    }
}

/// Whether `image` can be compared with `reference`: both of one size, the reference finite.
pub(crate) fn check(image: Image, reference: Image) -> Result<(), MetricsError> {
    let (a, b) = ((image.width, image.height), (reference.width, reference.height));
    if a != b {
        return Err(MetricsError::Sizes { image: a, reference: b });
    }
    match reference.pixels.iter().position(|p| !is_finite(*p)) {
        Some(index) => {
            let (x, y) = (index % reference.width as usize, index / reference.width as usize);
            Err(MetricsError::BadReference { x: x as u32, y: y as u32 })
        }
        None => Ok(()),
    }
}

/// Whether all channels are finite.
pub(crate) fn is_finite(Rgb(channels): Rgb) -> bool {
    channels.iter().all(|c| c.is_finite())
}

/// The number of pixels that have a channel that is infinite or not a number.
pub(crate) fn count_not_finite(image: Image) -> usize {
    image.pixels.iter().filter(|p| !is_finite(**p)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        let six = [Rgb::WHITE; 6];
        assert!(Image::new(3, 2, &six).is_ok());
        assert_eq!(Image::new(0, 2, &[]).unwrap_err(), MetricsError::Empty { width: 0, height: 2 });
        let wrong = MetricsError::PixelCount { width: 4, height: 2, found: 6 };
        assert_eq!(Image::new(4, 2, &six).unwrap_err(), wrong);
        assert!(Image::new(u32::MAX, u32::MAX, &six).is_err());
        let (lying, standing) = (Image::new(3, 2, &six).unwrap(), Image::new(2, 3, &six).unwrap());
        assert_eq!(
            check(lying, standing).unwrap_err(),
            MetricsError::Sizes { image: (3, 2), reference: (2, 3) }
        );
    }

    #[test]
    fn a_bad_reference_is_told_with_its_place() {
        let good = [Rgb::WHITE; 6];
        let mut bad = good;
        bad[5] = Rgb::new(0.0, f32::NAN, 0.0);
        let (good, bad) = (Image::new(3, 2, &good).unwrap(), Image::new(3, 2, &bad).unwrap());
        assert_eq!(check(good, bad).unwrap_err(), MetricsError::BadReference { x: 2, y: 1 });
        assert!(check(bad, good).is_ok());
        assert_eq!(count_not_finite(bad), 1);
    }
}
