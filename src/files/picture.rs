//! Picture files, written and read back. PNG and PPM hold 8 bits a component under the sRGB transfer curve, so that screens show the light
//! as it was computed; PFM, which the crate `image` does not know, holds the linear components as they are, not clamped.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::{ExtendedColorType, ImageEncoder, ImageFormat, ImageReader};
use scenes::model::{Picture, Vec3};

/// A picture of 8 bits a component, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Width and height.
    pub size: (u32, u32),
    /// Red, green and blue of each pixel.
    pub colours: Vec<[u8; 3]>,
}

/// A picture file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Portable network graphics.
    Png,
    /// Binary portable pixel map, `P6`.
    Ppm,
    /// Portable float map, `PF`, little-endian.
    Pfm,
}

impl PictureFormat {
    /// The format that a file's name asks for; standard output (`-`) gets a PNG.
    ///
    /// # Errors
    /// Another extension, or none.
    pub fn of(path: &Path) -> Result<PictureFormat, String> {
        if path == Path::new(super::STANDARD) {
            return Ok(PictureFormat::Png);
        }
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(PictureFormat::Png),
            Some("ppm") => Ok(PictureFormat::Ppm),
            Some("pfm") => Ok(PictureFormat::Pfm),
            _ => Err(format!("`{}` ends in none of .png, .ppm, .pfm", path.display())),
        }
    }

    /// The octets of a file in this format.
    pub fn encode(self, picture: &Picture) -> Vec<u8> {
        match self {
            PictureFormat::Png => png(&displayed(picture)),
            PictureFormat::Ppm => ppm(&displayed(picture)),
            PictureFormat::Pfm => pfm(picture),
        }
    }

    /// The pixels of a PNG or PPM of 8 bits a component, as a comparison with another picture needs them.
    ///
    /// # Errors
    /// Mistakes in the picture's file, in one line, and a PFM, whose components are no octets.
    pub fn decode(self, octets: &[u8]) -> Result<Pixels, String> {
        let format = match self {
            PictureFormat::Png => ImageFormat::Png,
            PictureFormat::Ppm => ImageFormat::Pnm,
            PictureFormat::Pfm => return Err("a PFM holds light, not the octets that a screen shows".into()),
        };
        let image = ImageReader::with_format(Cursor::new(octets), format).decode();
        let image = image.map_err(|error| error.to_string())?.into_rgb8();
        let colours = image.pixels().map(|pixel| pixel.0).collect();
        Ok(Pixels { size: image.dimensions(), colours })
    }

    /// The octets of a file that holds these pixels as they are, and in PFM as fractions of 255.
    pub fn encode_pixels(self, pixels: &Pixels) -> Vec<u8> {
        match self {
            PictureFormat::Png => png(pixels),
            PictureFormat::Ppm => ppm(pixels),
            PictureFormat::Pfm => pfm(&Picture {
                size: pixels.size,
                pixels: pixels.colours.iter().map(|colour| colour.map(|x| f64::from(x) / 255.0)).collect(),
            }),
        }
    }
}

/// A picture as screens expect it: clamped to [0, 1], sRGB transfer curve, 8 bits.
pub fn displayed(picture: &Picture) -> Pixels {
    let colours = picture.pixels.iter().map(|colour: &Vec3| colour.map(transferred)).collect();
    Pixels { size: picture.size, colours }
}

/// A linear component under the sRGB curve of IEC 61966-2-1, to nearest.
fn transferred(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let curved = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (curved * 255.0).round() as u8
}

/// End of the header chunk of a PNG: 8 octets of signature, then length, name, 13 octets of content and check sum.
const HEADER_END: usize = 8 + 4 + 4 + 13 + 4;

/// The chunk that says sRGB with the relative colorimetric intent, which `image` does not write: length, name, intent and check sum.
const SRGB: &[u8] = b"\0\0\0\x01sRGB\x01\xd9\xc9\x2c\x7f";

fn png(pixels: &Pixels) -> Vec<u8> {
    let mut out = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut out, CompressionType::Default, FilterType::Adaptive);
    let written =
        encoder.write_image(pixels.colours.as_flattened(), pixels.size.0, pixels.size.1, ExtendedColorType::Rgb8);
    written.expect("a picture with as many pixels as its size says fits a PNG in memory");
    out.splice(HEADER_END..HEADER_END, SRGB.iter().copied());
    out
}

fn ppm(pixels: &Pixels) -> Vec<u8> {
    let mut out = Vec::new();
    let encoder = PnmEncoder::new(&mut out).with_subtype(PnmSubtype::Pixmap(SampleEncoding::Binary));
    let (width, height) = pixels.size;
    let written = encoder.write_image(pixels.colours.as_flattened(), width, height, ExtendedColorType::Rgb8);
    written.expect("a picture with as many pixels as its size says fits a PPM in memory");
    // The encoder sets a blank between the height and 255; a line of its own is what other writers have.
    out[format!("P6\n{width} {height}").len()] = b'\n';
    out
}

fn pfm(picture: &Picture) -> Vec<u8> {
    let (width, height) = picture.size;
    // The sign of the scale says little-endian; rows go upwards.
    let mut out = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    for row in picture.pixels.chunks_exact(width.max(1) as usize).rev() {
        out.extend(row.as_flattened().iter().flat_map(|&component| (component as f32).to_le_bytes()));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        Picture { size: (1, 2), pixels: vec![[0.0, 0.5, 1.5], [-1.0, 0.25, 1.0]] }
    }

    #[test]
    fn names_choose_the_format() {
        assert_eq!(PictureFormat::of(Path::new("a/b.PNG")), Ok(PictureFormat::Png));
        assert_eq!(
            (PictureFormat::of(Path::new("b.ppm")), PictureFormat::of(Path::new("b.pfm"))),
            (Ok(PictureFormat::Ppm), Ok(PictureFormat::Pfm))
        );
        for name in ["b", "b.jpg", "png", ".png"] {
            assert!(PictureFormat::of(Path::new(name)).is_err(), "{name}");
        }
    }

    #[test]
    fn half_of_the_light_is_188_on_a_screen() {
        assert_eq!(displayed(&picture()).colours, [[0, 188, 255], [0, 137, 255]]);
        let steps: Vec<u8> = (0..=1000).map(|k| transferred(f64::from(k) / 1000.0)).collect();
        assert!(steps.is_sorted() && steps[0] == 0 && steps[1000] == 255);
    }

    #[test]
    fn every_format_has_its_header_and_its_rows() {
        let expected = Pixels { size: (1, 2), colours: vec![[0, 188, 255], [0, 137, 255]] };
        let png = PictureFormat::Png.encode(&picture());
        assert_eq!(PictureFormat::Png.decode(&png), Ok(expected.clone()));
        assert!(png.windows(4).any(|name| name == b"sRGB"));
        assert_eq!(PictureFormat::Ppm.decode(&PictureFormat::Ppm.encode(&picture())), Ok(expected));
        assert!(PictureFormat::Png.decode(&png[..40]).is_err() && PictureFormat::Pfm.decode(&png).is_err());
        assert_eq!(PictureFormat::Ppm.encode(&picture()), b"P6\n1 2\n255\n\x00\xbc\xff\x00\x89\xff");
        let pfm = PictureFormat::Pfm.encode(&picture());
        let rows: Vec<f32> =
            pfm[pfm.len() - 24..].chunks_exact(4).map(|x| f32::from_le_bytes(x.try_into().unwrap())).collect();
        assert!(pfm.starts_with(b"PF\n1 2\n-1.0\n"));
        assert_eq!(rows, [-1.0, 0.25, 1.0, 0.0, 0.5, 1.5], "the lowest row comes first");
    }
}
