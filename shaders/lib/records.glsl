// Scene objects are tagged records. A RecordRef is tag:8 | index:24; NO_RECORD refers to nothing.
const uint NO_RECORD = 0xFFFFFFFFu;
uint record_tag(uint ref) { return ref >> 24; }
uint record_index(uint ref) { return ref & 0xFFFFFFu; }

// Typed members of records. The type tells the host what to resolve the scene's parameter to.
struct MediumRef { uint ref; };             // a medium's name -> RecordRef of its record
struct PhaseRef { uint ref; };              // {"class": …} of a phase function -> RecordRef of its record
struct TextureRef { uint index; };          // a glTF textureInfo -> index of a Texture, NO_RECORD where absent
struct WorldPoint { vec3 position; };       // [x, y, z] -> m, in the device's world, whose origin is the scene's centre
struct SunDirection { vec3 unit; };         // [x, y, z], or {"latitude", "longitude", "time"}; 0 where none is given
struct Direction { vec3 unit; };            // [x, y, z] of any length -> unit vector
struct Placement { mat4x3 world_from_local; };  // the node's transform; needs no parameter
