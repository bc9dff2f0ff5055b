//! The secret that makes a visitor a pilot.

use std::fmt;

use subtle::ConstantTimeEq;

/// Bytes of a token: too many to be guessed.
const BYTES: usize = 16;

/// A secret of one run.
#[derive(Clone)]
pub struct Token(String);

impl Token {
    /// A new one from the randomness of the system.
    ///
    /// # Errors
    /// The system has no randomness.
    pub fn random() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; BYTES];
        getrandom::fill(&mut bytes)?;
        Ok(Self(bytes.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// Whether a text is the secret. How long that takes tells nothing of it.
    pub fn is(&self, text: &str) -> bool {
        self.0.as_bytes().ct_eq(text.as_bytes()).into()
    }

    /// The secret, for the person who started the program.
    pub fn secret(&self) -> &str {
        &self.0
    }
}

/// Never the secret: it would be in logs.
impl fmt::Debug for Token {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Token")
    }
}

#[cfg(test)]
mod tests {
    use super::Token;

    #[test]
    fn each_token_is_another_and_only_itself() {
        let [one, other] = [Token::random(), Token::random()].map(|token| token.expect("randomness"));
        assert!(one.is(one.secret()) && !one.is(other.secret()) && !one.is(""));
        assert_eq!(one.secret().len(), 32);
        assert!(!format!("{one:?}").contains(one.secret()));
    }
}
