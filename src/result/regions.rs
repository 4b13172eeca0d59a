//! Functions and regions of a profile as they stand in results.

use emu::profile::Profile;

use super::{ByClass, RegionCounts};

/// The functions of a profile, or the regions that are none, in the order of the program.
pub fn regions(profile: Option<&Profile>, is_function: bool) -> Vec<RegionCounts> {
    let regions = profile.map_or(&[][..], |profile| &profile.regions);
    let chosen = regions.iter().filter(|region| region.is_function == is_function);
    chosen
        .map(|region| RegionCounts {
            name: region.name.clone(),
            calls: region.calls,
            instructions: region.instructions,
            inclusive: ByClass(region.inclusive),
            exclusive: ByClass(region.exclusive),
        })
        .collect()
}
