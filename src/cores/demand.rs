//! Theory of cores that compute for a while, then need one shared bus: closed forms, no simulation.

use schemars::JsonSchema;
use serde::Serialize;

/// Demand of a pixel with nobody else on the bus, in clocks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PixelDemand {
    /// Clocks of computing; C.
    pub computing: f64,
    /// Clocks of the bus, the main processor's transfers included; M.
    pub transfer: f64,
}

impl PixelDemand {
    /// The report's, as it is printed. Report 6.1.
    pub fn report() -> PixelDemand {
        let printed = |id| kernels::annex::printed(id).expect("6.1 prints it");
        PixelDemand { computing: printed("pixel_operations"), transfer: printed("memory_clocks") }
    }

    /// C / M: the report's number of cores, which takes it that a core computes while its own transfer goes on. `None`
    /// without transfers.
    pub fn quotient(&self) -> Option<f64> {
        (self.transfer > 0.0).then(|| self.computing / self.transfer)
    }

    /// (C + M) / M: the number of cores that fill the bus when a core computes or waits, never both. `None` without
    /// transfers.
    pub fn saturation(&self) -> Option<f64> {
        Some(self.quotient()? + 1.0)
    }

    /// Clocks a pixel without any waiting: (C + M) / N as long as the bus has room, M beyond that.
    pub fn bound(&self, cores: u32) -> f64 {
        ((self.computing + self.transfer) / f64::from(cores)).max(self.transfer)
    }

    /// Clocks a pixel by mean value analysis: N machines that break down after C clocks on average and one repairman
    /// who takes M on average, both with exponential times. Real transfers vary less, so this waits more.
    pub fn queueing(&self, cores: u32) -> f64 {
        let mut queue = 0.0;
        let mut clocks = self.computing + self.transfer;
        for present in 1..=cores {
            // Who comes finds the queue that one machine fewer would have.
            let residence = self.transfer * (1.0 + queue);
            clocks = (self.computing + residence) / f64::from(present);
            queue = if clocks > 0.0 { residence / clocks } else { 0.0 };
        }
        clocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reports_figures() {
        let demand = PixelDemand::report();
        assert_eq!(format!("{:.2} {:.2}", demand.quotient().unwrap(), demand.saturation().unwrap()), "4.09 5.09");
        // 252,600 clocks with one core, 0.6315 ms at 100 MHz with four.
        assert_eq!([demand.bound(1), demand.bound(4), demand.bound(6)], [252_600.0, 63_150.0, 49_600.0]);
    }

    #[test]
    fn a_queue_makes_it_longer_and_vanishes_at_both_ends() {
        let demand = PixelDemand::report();
        assert_eq!(demand.queueing(1), demand.bound(1));
        for cores in 2..20 {
            assert!(demand.queueing(cores) > demand.bound(cores), "{cores}");
            assert!(demand.queueing(cores) < demand.queueing(cores - 1), "{cores}");
        }
        assert!((demand.queueing(40) / demand.transfer - 1.0).abs() < 1e-9);
        // Two cores with C = M = 1: X = N / (C + R), R = M (1 + Q), Q(1) = 1/2, so R = 1.5 and X = 2 / 2.5.
        assert_eq!(PixelDemand { computing: 1.0, transfer: 1.0 }.queueing(2), 1.25);
    }

    #[test]
    fn without_transfers_nothing_fills_the_bus() {
        let demand = PixelDemand { computing: 10.0, transfer: 0.0 };
        assert_eq!((demand.quotient(), demand.saturation()), (None, None));
        assert_eq!((demand.bound(5), demand.queueing(5)), (2.0, 2.0));
    }
}
