// Ctrl-C: the first asks the render to stop after the pass at hand and write the image so far; the second
// ends the program at once. A request to terminate (SIGTERM) counts as the same.
#pragma once

namespace etendue {

void catch_interrupts();  // to be called once, by commands that poll `interrupted`
bool interrupted();

}  // namespace etendue
