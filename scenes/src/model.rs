//! A scene as its files describe it, in double precision and in the user's units. Nothing here knows of grids or formats.

use messages::{Diagnostic, Report};

/// Position, direction or colour in double precision.
pub type Vec3 = [f64; 3];

/// Surface of a triangle: the report's material line `r g b reflection intensity index` (report 5.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Diffuse colour, components in [0, 1].
    pub colour: Vec3,
    /// Specular coefficient ks, in [0, 1].
    pub reflection: f64,
    /// Diffuse coefficient kd, in [0, 1].
    pub intensity: f64,
    /// Index of refraction against the void; 0 for an opaque material.
    pub index: f64,
}

impl Material {
    /// Transmission coefficient kt: max(0, 1 - ks - kd) where the material is transparent, else 0.
    pub fn transmission(&self) -> f64 {
        if self.index > 0.0 { (1.0 - self.reflection - self.intensity).max(0.0) } else { 0.0 }
    }
}

/// A point light without fall-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position of the light, in scene units.
    pub position: Vec3,
    /// The light's colour, components in [0, 1].
    pub colour: Vec3,
}

/// A triangle: three vertices by number, and its material by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Scene::vertices`].
    pub vertices: [u32; 3],
    /// Index into [`Scene::materials`].
    pub material: u32,
}

/// Everything that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Short name, from the file's stem or the generator.
    pub name: String,
    /// Width and height of the picture in pixels.
    pub size: (u32, u32),
    /// The surfaces.
    pub materials: Vec<Material>,
    /// The lights.
    pub lights: Vec<Light>,
    /// Positions in scene units.
    pub vertices: Vec<Vec3>,
    /// The triangles; their order is their index.
    pub triangles: Vec<Triangle>,
}

impl Scene {
    /// Smallest and largest corner of the triangles' box, `None` when there is no triangle.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let mut corners = self.triangles.iter().flat_map(|t| t.vertices).map(|v| self.vertices[v as usize]);
        let first = corners.next()?;
        Some(corners.fold((first, first), |(low, high), p| {
            ([0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k])))
        }))
    }

    /// Defects that make the scene unusable, wherever it came from: numbers of vertices and materials that do not exist, values that are not
    /// finite, material coefficients outside [0, 1]. At most one message a kind.
    pub fn check(&self) -> Report {
        let mut messages = Vec::new();
        let mut refuse = |message: Option<String>| messages.extend(message.map(Diagnostic::error));
        let (vertices, materials) = (self.vertices.len(), self.materials.len());
        // Numbers of vertices and materials: each must exist
        refuse(self.triangles.iter().enumerate().find_map(|(k, t)| {
            let vertex = t.vertices.into_iter().find(|&v| v as usize >= vertices)?;
            Some(format!("triangle {k} has vertex {vertex}, but there are {vertices} vertices, counted from 0"))
        }));
        refuse(self.triangles.iter().enumerate().find_map(|(k, t)| {
            let is_known = (t.material as usize) < materials;
            (!is_known)
                .then(|| format!("triangle {k} has material {}, but there are {materials}, counted from 0", t.material))
        }));
        // Positions and lights: finite, and no light takes light away
        refuse(
            self.vertices
                .iter()
                .position(|v| !v.iter().all(|x| x.is_finite()))
                .map(|k| format!("vertex {k} is not finite: {:?}", self.vertices[k])),
        );
        refuse(self.lights.iter().position(|l| !l.position.iter().chain(&l.colour).all(|x| x.is_finite())).map(|k| {
            let Light { position, colour } = self.lights[k];
            format!("light {k} is not finite: its position is {position:?}, its colour {colour:?}")
        }));
        refuse(
            self.lights
                .iter()
                .position(|l| l.colour.iter().any(|&x| x < 0.0))
                .map(|k| format!("light {k} has a negative colour: {:?}", self.lights[k].colour)),
        );
        // Coefficients: NaN is in no range, so it is refused with all that is outside of 0 to 1.
        refuse(self.materials.iter().enumerate().find_map(|(k, m)| {
            let named = [("reflection", m.reflection), ("intensity", m.intensity)].into_iter();
            let all = named.chain(m.colour.map(|x| ("colour", x)));
            let (name, value) = all.into_iter().find(|(_, x)| !(0.0..=1.0).contains(x))?;
            Some(format!("material {k} has a {name} of {value}, which is not in 0 to 1"))
        }));
        refuse(
            self.materials
                .iter()
                .position(|m| !(m.index.is_finite() && m.index >= 0.0))
                .map(|k| format!("material {k} has an index of refraction of {}", self.materials[k].index)),
        );
        Report(messages)
    }
}

/// The view of a scene: camera, size and light of the surroundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// Parallel rays along -z, centred on the scene's box; the pixel pitch is max(box width / W, box height / H).
    Orthographic,
    /// Rays from one eye; `None` where the default stands: eye at (cx, cy, zmax + 1.2 max(bw, bh)), looking at the box's centre.
    Perspective {
        /// Eye position in scene units.
        eye: Option<Vec3>,
        /// Point that the centre of the picture shows, in scene units.
        look: Option<Vec3>,
        /// Vertical field of view in degrees (default 45).
        field: f64,
    },
}

/// Wishes of a user for a picture beside the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The camera.
    pub camera: Camera,
    /// Moves every sample by this many pixel pitches, x right, y up.
    pub shift: [f64; 2],
    /// Ambient intensity (default 0.1).
    pub ambient: f64,
    /// Colour where a ray hits nothing (default black).
    pub background: Vec3,
    /// Levels of secondary rays below the camera ray (default 5).
    pub bounces: u32,
}

impl View {
    /// The defaults for a picture of `size` pixels.
    pub fn new(size: (u32, u32)) -> View {
        View { size, camera: Camera::Orthographic, shift: [0.0; 2], ambient: 0.1, background: [0.0; 3], bounces: 5 }
    }

    /// Defects that make the view unusable: an empty picture, values that are not finite, shifts beyond 65536 pixels, negative light. At most one message a kind.
    pub fn check(&self) -> Report {
        let mut messages = Vec::new();
        if self.size.0 == 0 || self.size.1 == 0 {
            messages.push(Diagnostic::error(format!("a picture of {} x {} pixels has none", self.size.0, self.size.1)));
        }
        let points = match self.camera {
            Camera::Orthographic => [None, None],
            Camera::Perspective { eye, look, .. } => [eye, look],
        };
        for (name, point) in ["--eye", "--look"].into_iter().zip(points) {
            if let Some(point) = point.filter(|p| !p.iter().all(|x| x.is_finite())) {
                messages.push(Diagnostic::error(format!("{name} is not finite: {point:?}")));
            }
        }
        if !self.shift.iter().all(|x| x.abs() <= 65_536.0) {
            let message = Diagnostic::error(format!("a shift of {:?} leads out of any picture", self.shift));
            messages
                .push(message.hint("--shift counts pixel pitches; a sample is moved within its pixel by less than 1"));
        }
        if !(self.ambient.is_finite() && self.ambient >= 0.0) {
            messages.push(Diagnostic::error(format!("an ambient intensity of {} is no light", self.ambient)));
        }
        if !self.background.iter().all(|&x| x.is_finite() && x >= 0.0) {
            messages.push(Diagnostic::error(format!("a background of {:?} is no colour", self.background)));
        }
        Report(messages)
    }
}

/// A picture in linear components, row 0 on top, `width * height` pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Red, green and blue of each pixel; not clamped.
    pub pixels: Vec<Vec3>,
}
