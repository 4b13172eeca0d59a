//! Options of camera, size and light.

use clap::Args;

use super::value::{self, Rectangle, Size};
use crate::settings::{CameraKind, ViewSettings};

/// Options of the camera.
#[derive(Args, Clone, Copy, Debug)]
pub struct CameraArguments {
    /// Camera [default: orthographic, or perspective when --eye, --look or --fov is given].
    #[arg(long, value_enum, value_name = "KIND", hide_possible_values = false)]
    pub camera: Option<CameraKind>,
    /// Position of the eye, in scene units [default: in front of the box].
    #[arg(long, value_name = "X,Y,Z", value_parser = value::point::<3>, allow_hyphen_values = true)]
    pub eye: Option<[f64; 3]>,
    /// Point that the picture's centre shows, in scene units [default: the box's centre].
    #[arg(long, value_name = "X,Y,Z", value_parser = value::point::<3>, allow_hyphen_values = true)]
    pub look: Option<[f64; 3]>,
    /// Vertical field of view, in degrees [default: 45].
    #[arg(long, value_name = "DEGREES", value_parser = field, allow_hyphen_values = true)]
    pub fov: Option<f64>,
}

/// Options of the view.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "View")]
pub struct ViewArguments {
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub camera: CameraArguments,
    /// Size of the picture, in pixels [default: the size in the .dsc, else 320x240].
    #[arg(long, value_name = "WxH", value_parser = value::size)]
    pub size: Option<Size>,
    /// Moves every sample by this many pixels, x right, y up.
    #[arg(long, value_name = "DX,DY", value_parser = value::point::<2>, allow_hyphen_values = true, default_value = "0,0")]
    pub shift: [f64; 2],
    /// Draws only a part of the picture, in pixels: first column, first row from the top, width, height.
    #[arg(long, value_name = "X,Y,W,H", value_parser = value::rectangle, allow_hyphen_values = true)]
    pub crop: Option<Rectangle>,
    /// Draws only one pixel: its column and its row from the top.
    #[arg(long, value_name = "X,Y", value_parser = value::whole::<2>, allow_hyphen_values = true, conflicts_with = "crop")]
    pub pixel: Option<[u32; 2]>,
    /// Ambient intensity.
    #[arg(long, value_name = "I", value_parser = intensity, allow_hyphen_values = true, default_value = "0.1")]
    pub ambient: f64,
    /// Colour where a ray hits nothing, components of 0 to 1.
    #[arg(long, value_name = "R,G,B", value_parser = colour, allow_hyphen_values = true, default_value = "0,0,0")]
    pub background: [f64; 3],
}

impl CameraArguments {
    /// Settings of the view with this camera, and nothing else that the user chose.
    pub fn settings(self) -> ViewSettings {
        let CameraArguments { camera, eye, look, fov } = self;
        ViewSettings { camera, eye, look, fov, ..ViewSettings::default() }
    }
}

fn field(text: &str) -> Result<f64, String> {
    let [degrees] = value::point(text)?;
    match degrees > 0.0 && degrees < 180.0 {
        true => Ok(degrees),
        false => Err("a field of view lies between 0 and 180 degrees".into()),
    }
}

fn intensity(text: &str) -> Result<f64, String> {
    let [intensity] = value::point(text)?;
    if intensity >= 0.0 { Ok(intensity) } else { Err("an intensity is at least 0".into()) }
}

fn colour(text: &str) -> Result<[f64; 3], String> {
    let colour = value::point(text)?;
    let is_colour = colour.iter().all(|component| (0.0..=1.0).contains(component));
    if is_colour { Ok(colour) } else { Err("the components of a colour lie in 0 to 1".into()) }
}
