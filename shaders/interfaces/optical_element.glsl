// OpticalElement: a black box with its own records, frame and hierarchy. A ray enters at one place of its boundary and
// may leave at another. A class NAME defines, for its record R:
//
//   bool NAME_enter(R r, inout ElementRay ray)    takes a ray at the boundary, in the element's frame
//   bool NAME_leave(R r, inout ElementRay ray)    returns it elsewhere; false while it is still inside
//
// No class is registered yet.
