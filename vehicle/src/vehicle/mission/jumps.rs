//! Which step follows which.

use std::collections::BTreeMap;

use crate::plan::Program;
use crate::plan::step::{Jump, Step};

/// What follows a step.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Next {
    /// The next step that is flown, if there is one.
    pub navigation: Option<usize>,
    /// Steps to be done on the way to it.
    pub actions: Vec<usize>,
    /// Jumps that were made.
    pub jumps: Vec<usize>,
}

/// How often each jump has been made.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Jumps(BTreeMap<usize, u32>);

impl Jumps {
    /// Counts anew.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// What follows from step `from` on, itself included; counts the jumps on the way. Jumps that lead in a circle without a step
    /// that is flown end the search.
    pub fn next(&mut self, program: &Program, from: usize) -> Next {
        let mut next = Next::default();
        let mut index = from;
        for _ in 0..=2 * program.len() {
            match program.step(index) {
                None => break,
                Some(Step::Navigate(_)) => {
                    next.navigation = Some(index);
                    break;
                }
                Some(Step::Jump(Jump { to, repeats })) => {
                    let count = self.0.entry(index).or_default();
                    if repeats.is_none_or(|repeats| *count < repeats) {
                        *count = count.saturating_add(1);
                        next.jumps.push(index);
                        index = to;
                        continue;
                    }
                }
                Some(Step::Condition(_) | Step::Do(_) | Step::Pass) => next.actions.push(index),
            }
            index += 1;
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::{Jump, Jumps, Program, Step};
    use crate::plan::step::{Delay, Do, Navigate};
    use crate::plan::{ChangeSpeed, ProgramStep};

    const FLOWN: Step = Step::Navigate(Navigate::Delay(Delay::For(0.0)));

    fn program(steps: &[Step]) -> Program {
        Program::new(steps.iter().map(|step| ProgramStep { step: *step, continues: true }).collect(), 0)
    }

    #[test]
    fn jumps_are_made_as_often_as_asked() {
        let speed = Step::Do(Do::ChangeSpeed(ChangeSpeed::of(1.0, 3.0).unwrap()));
        let jump = Step::Jump(Jump { to: 0, repeats: Some(2) });
        let program = program(&[FLOWN, speed, FLOWN, jump, FLOWN]);
        let mut made = Jumps::default();
        let mut order = Vec::new();
        let mut from = 0;
        while let Some(index) = made.next(&program, from).navigation {
            order.push(index);
            from = index + 1;
        }
        assert_eq!(order, [0, 2, 0, 2, 0, 2, 4]);
        assert_eq!(made.next(&program, 1).actions, [1]);
    }

    #[test]
    fn jumps_in_a_circle_end() {
        let jump = |to| Step::Jump(Jump { to, repeats: None });
        let program = program(&[jump(1), jump(0)]);
        assert_eq!(Jumps::default().next(&program, 0).navigation, None);
    }
}
