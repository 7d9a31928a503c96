//! Node, values, application and storage in one type.

use od_model::Dictionary;
use od_model::typed::{DeviceWritable, Scalar, Var};
use od_runtime::storage::Storage;
use od_runtime::{
    Application, BusEvent, Device, Event, Extras, Frame, Instant, Lent, Node, NodeId, Store, Unfit,
};
use od_wire::CanId;

use crate::owner::Owner;

/// A CANopen node that owns all it needs, so that it can be a `static`.
///
/// `object_dictionary!` makes the type `Board<A, S>` of each module, with the sizes of its
/// dictionary: `PDO`, `SDO` and `X` are those of [`Node`], `LEN` is the number of bytes of the values.
/// Dictionary and profile are those of `D`; without `behaves` the profile is [`Profile::CIA301`](od_runtime::Profile::CIA301).
///
/// Inputs and outputs are the functions of [`Owner`].
#[derive(Debug)]
pub struct Board<
    D,
    A,
    S,
    const PDO: usize,
    const SDO: usize,
    const LEN: usize,
    X: Extras<D, SDO> = (),
> {
    node: Node<D, PDO, SDO, X>,
    values: [u8; LEN],
    /// Behaviour of the device. After a change call [`handle_change`](Owner::handle_change), or use
    /// [`change`](Self::change).
    pub application: A,
    /// Memory for the values saved with 1010h.
    pub storage: S,
}

impl<
    D: Device,
    A: Application,
    S: Storage,
    const PDO: usize,
    const SDO: usize,
    const LEN: usize,
    X: Extras<D, SDO>,
> Board<D, A, S, PDO, SDO, LEN, X>
{
    const DICTIONARY: &'static Dictionary<'static> = match &D::DICTIONARY {
        Some(dictionary) => {
            assert!(
                dictionary.store_len() <= LEN,
                "a board has room for all values of its dictionary: `STORE_LEN`"
            );
            dictionary
        }
        None => panic!("a board has a dictionary that the compiler knows"),
    };

    /// A board without power, whose node starts with this node ID.
    pub const fn new(node_id: NodeId, application: A, storage: S) -> Self {
        let _ = Self::DICTIONARY;
        Self {
            node: Node::new(node_id),
            values: [0; LEN],
            application,
            storage,
        }
    }

    /// The node.
    pub const fn node(&self) -> &Node<D, PDO, SDO, X> {
        &self.node
    }

    /// Calls a function of the node that is not one of [`Owner`], such as [`Node::raise`].
    pub fn call<R>(
        &mut self,
        act: impl FnOnce(&mut Node<D, PDO, SDO, X>, &mut Lent<'_>) -> R,
    ) -> R {
        let (node, mut lent) = self.parts();
        act(node, &mut lent)
    }

    /// Power comes: the values become the saved ones or their defaults, and the node boots up.
    ///
    /// # Errors
    /// [`Unfit`] where the node does not fit its dictionary, which the compiler has checked.
    pub fn power_on(&mut self, now: Instant) -> Result<(), Unfit> {
        self.call(|node, lent| node.power_on(lent, now))
    }

    /// Changes the application or values from the side of the device; event-driven TPDOs of what
    /// changed follow at once.
    pub fn change<R>(
        &mut self,
        now: Instant,
        act: impl FnOnce(&mut A, &mut Store<'_>) -> R,
    ) -> Option<R> {
        let node_id = self.node.node_id();
        let mut store = Store::new(Self::DICTIONARY, &mut self.values, node_id).ok()?;
        let result = act(&mut self.application, &mut store);
        self.handle_change(now);
        Some(result)
    }

    /// The value of a handle.
    pub fn get<T: Scalar, B, M>(&mut self, var: Var<T, B, M>) -> T {
        match Store::new(Self::DICTIONARY, &mut self.values, self.node.node_id()) {
            Ok(store) => store.get(var),
            Err(_) => T::from_wire(&[]),
        }
    }

    /// Sets the value of a handle, as [`change`](Self::change) does.
    pub fn set<T: Scalar, B: DeviceWritable, M>(
        &mut self,
        now: Instant,
        var: Var<T, B, M>,
        value: T,
    ) {
        self.change(now, |_, store| store.set(var, value));
    }

    fn parts(&mut self) -> (&mut Node<D, PDO, SDO, X>, Lent<'_>) {
        let lent = Lent {
            dictionary: *Self::DICTIONARY,
            values: &mut self.values,
            application: &mut self.application,
            storage: &mut self.storage,
            profile: None,
        };
        (&mut self.node, lent)
    }
}

impl<
    D: Device,
    A: Application,
    S: Storage,
    const PDO: usize,
    const SDO: usize,
    const LEN: usize,
    X: Extras<D, SDO>,
> Owner for Board<D, A, S, PDO, SDO, LEN, X>
{
    fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        let (node, mut lent) = self.parts();
        node.handle_frame(&mut lent, now, frame);
    }

    fn handle_timeout(&mut self, now: Instant) {
        let (node, mut lent) = self.parts();
        node.handle_timeout(&mut lent, now);
    }

    fn handle_change(&mut self, now: Instant) {
        let (node, mut lent) = self.parts();
        node.handle_change(&mut lent, now);
    }

    fn handle_bus(&mut self, now: Instant, event: BusEvent) {
        let (node, mut lent) = self.parts();
        node.handle_bus(&mut lent, now, event);
    }

    fn is_bus_off(&self) -> bool {
        self.node.is_bus_off()
    }

    fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        let (node, mut lent) = self.parts();
        node.poll_transmit(&mut lent, now)
    }

    fn poll_timeout(&self) -> Option<Instant> {
        self.node.poll_timeout()
    }

    fn poll_event(&mut self) -> Option<Event> {
        self.node.poll_event()
    }

    fn poll_wanted_ids(&mut self, each: &mut dyn FnMut(CanId)) {
        if let Some(ids) = self.node.poll_wanted_ids() {
            ids.for_each(each);
        }
    }
}
