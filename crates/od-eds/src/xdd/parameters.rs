//! A value in the device profile: its parameter, and the parameter's template.

use alloc::string::String;

use roxmltree::Node;

use crate::span::Spanned;
use crate::xdd::source::{Ids, Reader, children};
use crate::xdd::types;

/// A parameter with its template.
#[derive(Clone, Copy)]
pub(super) struct Parameter<'a, 'i> {
    own: Node<'a, 'i>,
    template: Option<Node<'a, 'i>>,
}

impl<'a, 'i> Parameter<'a, 'i> {
    pub(super) fn new(own: Node<'a, 'i>, ids: &Ids<'a, 'i>) -> Self {
        let template = own
            .attribute("templateIDRef")
            .and_then(|id| ids.get(id))
            .filter(|template| *template != own);
        Self { own, template }
    }

    pub(super) fn element(&self) -> Node<'a, 'i> {
        self.own
    }

    fn both(&self) -> impl Iterator<Item = Node<'a, 'i>> {
        core::iter::once(self.own).chain(self.template)
    }

    /// `access`; `read` if it is missing, as in the schema.
    pub(super) fn access(&self, reader: &Reader<'_>) -> Option<Spanned<String>> {
        self.both()
            .find_map(|node| reader.attribute(node, "access"))
    }

    pub(super) fn data_type(&self, ids: &Ids<'_, '_>) -> Option<types::Found> {
        self.both().find_map(|node| types::of(node, ids))
    }

    /// The `value` of a child: `defaultValue`, `actualValue`.
    pub(super) fn value(&self, name: &'static str, reader: &Reader<'_>) -> Option<Spanned<String>> {
        self.both()
            .flat_map(|node| children(node, name))
            .find_map(|value| reader.attribute(value, "value"))
    }

    /// `minValue` or `maxValue` of the only range of the allowed values. Several ranges or single
    /// values cannot be limits of an object dictionary.
    pub(super) fn limit(&self, name: &'static str, reader: &Reader<'_>) -> Option<Spanned<String>> {
        let allowed = self
            .both()
            .flat_map(|node| children(node, "allowedValues"))
            .next()?;
        let mut ranges = children(allowed, "range");
        let range = ranges.next()?;
        if ranges.next().is_some() {
            return None;
        }
        let limit = children(range, name).next()?;
        reader.attribute(limit, "value")
    }

    /// The text of a `label` in this element or in its child of the name.
    pub(super) fn label(
        &self,
        within: Option<&'static str>,
        reader: &Reader<'_>,
    ) -> Option<Spanned<String>> {
        self.both().find_map(|node| {
            let holder = match within {
                Some(name) => children(node, name).next()?,
                None => node,
            };
            let label = children(holder, "label").next()?;
            reader.text(label)
        })
    }

    /// The value of a `property` of this name.
    pub(super) fn property(&self, name: &str, reader: &Reader<'_>) -> Option<Spanned<String>> {
        children(self.own, "property")
            .find(|property| property.attribute("name") == Some(name))
            .and_then(|property| reader.attribute(property, "value"))
    }
}
