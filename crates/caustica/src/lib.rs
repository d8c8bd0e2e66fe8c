//! caustica
