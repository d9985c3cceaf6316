// A member of a struct that a scene or an algorithm may lack: MEMBER_IF(HAS_BENDING, Bend bend;) is there where the macro is 1.
// What stands in memory is declared once, and takes no room for what is not needed.
#include "features/defaults.glsl"
#define MEMBER_IF_0(member)
#define MEMBER_IF_1(member) member
#define MEMBER_IF_VALUE(feature, member) MEMBER_IF_##feature(member)
#define MEMBER_IF(feature, member) MEMBER_IF_VALUE(feature, member)
