//! All faults of a call, each at its token; faults of the EDS at the path.

use od_model::patch::token_of;
use od_model::{Address, Diagnostic};
use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, TokenStreamExt};

/// So many faults of one EDS file are shown; the rest is counted.
const SHOWN: usize = 20;

/// Collects what is wrong with a call.
#[derive(Default)]
pub(crate) struct Report {
    errors: Vec<syn::Error>,
    tokens: Vec<Place>,
}

/// From the first token to the last.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) first: Span,
    pub(crate) last: Span,
}

impl From<Span> for Place {
    fn from(span: Span) -> Self {
        Self {
            first: span,
            last: span,
        }
    }
}

impl ToTokens for Place {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        for span in [self.first, self.last] {
            tokens.append(Ident::new("_", span));
        }
    }
}

impl Report {
    /// Takes a fault.
    pub(crate) fn push(&mut self, error: syn::Error) {
        self.errors.push(error);
    }

    /// A fault at this place.
    pub(crate) fn at(&mut self, place: impl Into<Place>, message: impl std::fmt::Display) {
        self.tokens(place.into(), message);
    }

    /// A fault of these tokens.
    pub(crate) fn tokens(&mut self, tokens: impl ToTokens, message: impl std::fmt::Display) {
        self.errors.push(syn::Error::new_spanned(tokens, message));
    }

    /// A span for the model that leads back to this token.
    pub(crate) fn number(&mut self, place: impl Into<Place>) -> od_model::Span {
        self.tokens.push(place.into());
        od_model::patch::token(u32::try_from(self.tokens.len() - 1).unwrap_or(u32::MAX))
    }

    /// The token behind a finding, if it came from one.
    pub(crate) fn token(&self, finding: &Diagnostic) -> Option<Place> {
        self.span(finding.span?)
    }

    /// The token behind a span of the model.
    pub(crate) fn span(&self, span: od_model::Span) -> Option<Place> {
        self.tokens.get(token_of(span)? as usize).copied()
    }

    /// Nothing told so far?
    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// Tells a finding at the token that caused it; `context` goes before the message.
    pub(crate) fn blame(
        &mut self,
        at: Place,
        context: &str,
        finding: &Diagnostic,
        file: Option<&str>,
        names: &dyn Fn(Address) -> Option<String>,
    ) {
        let mut text = context.to_string();
        text.push_str(&render(finding, None, names));
        if let (Some(file), Some(span), None) = (file, finding.span, self.token(finding)) {
            let (line, column) = (span.line, span.column);
            text.push_str(&format!("\nnote: it stands at {file}:{line}:{column}"));
        }
        self.at(at, text);
    }

    /// Tells the model's findings: at their tokens, or all together at `home`
    /// with the place in `file` in the text.
    pub(crate) fn findings(
        &mut self,
        findings: &[Diagnostic],
        home: Span,
        file: Option<&str>,
        names: &dyn Fn(Address) -> Option<String>,
    ) {
        let mut shown = 0;
        let mut hidden = 0usize;
        for finding in findings.iter().filter(|f| f.is_error()) {
            if let Some(span) = self.token(finding) {
                self.at(span, render(finding, None, names));
            } else if shown < SHOWN {
                shown += 1;
                self.at(home, render(finding, file, names));
            } else {
                hidden += 1;
            }
        }
        if hidden > 0 {
            let file = file.unwrap_or("the EDS file");
            self.at(
                home,
                format!("{file}: {hidden} more errors\nhelp: `odkit check` shows them all"),
            );
        }
    }

    /// `compile_error!` for each fault.
    pub(crate) fn into_tokens(self) -> TokenStream {
        self.errors
            .iter()
            .map(syn::Error::to_compile_error)
            .collect()
    }
}

/// `file:line:column: [E0412] object 2300h:09 "Reset": message`, and the help below.
fn render(
    finding: &Diagnostic,
    file: Option<&str>,
    names: &dyn Fn(Address) -> Option<String>,
) -> String {
    let mut text = String::new();
    if let Some(file) = file {
        text.push_str(file);
        if let Some(span) = finding.span {
            text.push_str(&format!(":{}:{}", span.line, span.column));
        }
        text.push_str(": ");
    }
    text.push_str(&format!("[{}] ", finding.code));
    // Findings of a patch say in words what they are about.
    if let Some(address) = finding.address
        && !finding.code.starts_with("E07")
    {
        match names(address) {
            Some(name) => text.push_str(&format!("object {address} {name:?}: ")),
            None => text.push_str(&format!("object {address}: ")),
        }
    }
    text.push_str(&finding.message);
    if let Some(file) = file {
        for label in &finding.labels {
            let (line, column) = (label.span.line, label.span.column);
            text.push_str(&format!("\nnote: {file}:{line}:{column}: {}", label.text));
        }
    }
    if !finding.help.is_empty() {
        text.push_str(&format!("\nhelp: {}", finding.help));
    }
    text
}
