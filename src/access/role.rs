//! Roles of keys.

/// What a key allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Create, move, fork and delete contacts, and all that [`Role::Read`] allows.
    Write,
    /// Read contacts, and run simulations that are not stored.
    Read,
    /// Read the metrics of the service, and nothing else.
    Metrics,
}

impl Role {
    /// All roles.
    pub const ALL: [Role; 3] = [Role::Write, Role::Read, Role::Metrics];

    /// Its name in a file of keys.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Role::Write => "write",
            Role::Read => "read",
            Role::Metrics => "metrics",
        }
    }

    /// The role of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Role> {
        Role::ALL.into_iter().find(|role| role.name() == name)
    }

    fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// The roles of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Roles(u8);

impl Roles {
    /// These, and what they include.
    #[must_use]
    pub fn new(roles: &[Role]) -> Roles {
        let given = roles.iter().fold(0, |bits, role| bits | role.bit());
        let included = if given & Role::Write.bit() == 0 { 0 } else { Role::Read.bit() };
        Roles(given | included)
    }

    /// Whether a role is among them.
    #[must_use]
    pub fn allow(self, role: Role) -> bool {
        self.0 & role.bit() != 0
    }
}
