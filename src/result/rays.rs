//! Rays of a picture by kind.

use emu::profile::{Profile, RegionProfile};
use kernels::Function;
use schemars::JsonSchema;
use serde::Serialize;

/// Rays by kind, counted from calls of the kernels' functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct RaysByKind {
    /// One a pixel that is not interpolated.
    pub camera: u64,
    /// Reflected ones, total reflection included.
    pub reflected: u64,
    /// Refracted ones.
    pub refracted: u64,
    /// Rays towards lights.
    pub shadow: u64,
}

impl RaysByKind {
    /// Rays of all kinds.
    pub fn all(&self) -> u64 {
        self.camera + self.reflected + self.refracted + self.shadow
    }

    /// The rays of a picture of `pixels` pixels. Each secondary and each shadow ray calls `own_packet` once.
    pub(super) fn new(pixels: u64, profile: Option<&Profile>) -> RaysByKind {
        let calls = |function: Function| {
            let regions = profile.map_or(&[][..], |profile| &profile.regions);
            let named = |region: &&RegionProfile| region.is_function && region.name == function.name();
            regions.iter().find(named).map_or(0, |region| region.calls)
        };
        // Each ray but a camera ray starts in its own packet; those that are neither reflected nor refracted are shadow rays.
        let (reflected, refracted) = (calls(Function::Reflect), calls(Function::Refract));
        let shadow = calls(Function::OwnPacket).saturating_sub(reflected + refracted);
        RaysByKind { camera: pixels, reflected, refracted, shadow }
    }
}
