//! How many steps the time that passes makes.

/// Steps that are due and made.
#[derive(Debug, Default)]
pub struct Pace {
    /// Time that has passed since the last step that was due, s.
    owed: f64,
    /// Time for which no steps could be made, s.
    pub behind: f64,
    /// Steps since the start.
    pub steps: usize,
    /// What a step of the last call took, ms.
    pub step_ms: Option<f64>,
    /// Whether time runs on, and what is shown is on its way from step to step.
    runs: bool,
}

/// Round-off of times that add up to a step.
const ROUND_OFF: f64 = 1e-9;

impl Pace {
    /// Lets time pass, and gives how many steps are due.
    pub fn due(&mut self, seconds: f64, time_step: f64) -> usize {
        self.runs = true;
        self.owed += seconds.max(0.0);
        let due = (self.owed / time_step + ROUND_OFF).floor();
        self.owed = (self.owed - due * time_step).max(0.0);
        due as usize
    }

    /// Steps that were due and will not be made.
    pub fn give_up(&mut self, steps: usize, time_step: f64) {
        self.behind += steps as f64 * time_step;
    }

    /// Counts steps that were made, and how long they took together.
    pub fn made(&mut self, steps: usize, milliseconds: f64) {
        self.steps += steps;
        self.step_ms = (steps > 0).then(|| milliseconds / steps as f64);
    }

    /// Time does not run on: the last step is what is shown.
    pub fn stop(&mut self) {
        (self.owed, self.runs) = (0.0, false);
    }

    /// How much of the way from the last step but one to the last has passed.
    pub fn part(&self, time_step: f64) -> f64 {
        if self.runs { (self.owed / time_step).min(1.0) } else { 1.0 }
    }
}
