//! Which item follows which.

use std::collections::BTreeMap;

use crate::plan::Program;
use crate::plan::step::{Jump, Step};

/// What follows an item.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Next {
    /// The next step that is flown, if there is one.
    pub navigation: Option<usize>,
    /// Steps to be done on the way to it.
    pub actions: Vec<usize>,
    /// Jumps that were made.
    pub jumps: Vec<usize>,
}

/// What follows from item `from` on, itself included. `made` counts the jumps that were made, and is counted up. Jumps that
/// lead in a circle without a step that is flown end the search.
pub fn next_from(program: &Program, from: usize, made: &mut BTreeMap<usize, u32>) -> Next {
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
                let count = made.entry(index).or_default();
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{Jump, Program, Step, next_from};
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
        let mut made = BTreeMap::new();
        let mut order = Vec::new();
        let mut from = 0;
        while let Some(index) = next_from(&program, from, &mut made).navigation {
            order.push(index);
            from = index + 1;
        }
        assert_eq!(order, [0, 2, 0, 2, 0, 2, 4]);
        assert_eq!(next_from(&program, 1, &mut made).actions, [1]);
    }

    #[test]
    fn jumps_in_a_circle_end() {
        let jump = |to| Step::Jump(Jump { to, repeats: None });
        let program = program(&[jump(1), jump(0)]);
        assert_eq!(next_from(&program, 0, &mut BTreeMap::new()).navigation, None);
    }
}
