//! What the user gets.
