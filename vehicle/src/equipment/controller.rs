//! Who may point the gimbal.

/// A client, by its system and component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Controller {
    /// System.
    pub system: u8,
    /// Component.
    pub component: u8,
}

/// Who has taken control of the gimbal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct GimbalControl {
    /// Who points it.
    pub primary: Option<Controller>,
    /// Who may point it, too.
    pub secondary: Option<Controller>,
}

impl GimbalControl {
    /// Whether a client has taken control.
    pub fn has(&self, client: Controller) -> bool {
        self.primary == Some(client) || self.secondary == Some(client)
    }
}
