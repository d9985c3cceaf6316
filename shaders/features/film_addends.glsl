// Samples of a half of the film that are not added to it yet, MOST_ADDENDS at most.
#include "lib/film.glsl"
#include "lib/samples.glsl"

struct FilmAddends {
    Digits sum;
    Digits squares;
    MEMBER_IF(MERGE_VERTICES, Digits bias;)
};

#if MERGE_VERTICES
FilmAddends no_addends() { return FilmAddends(no_digits(), no_digits(), no_digits()); }
#define add_bias(addends, sample) add_exactly(addends.bias, sample.bias)
#define ADD_BIAS(place, addends) ADD_DIGITS(film[place].bias, addends.bias)
#else
FilmAddends no_addends() { return FilmAddends(no_digits(), no_digits()); }
#define add_bias(addends, sample)
#define ADD_BIAS(place, addends)
#endif

void add_sample(inout FilmAddends addends, Sample s) {
    add_exactly(addends.sum, s.value);
    add_exactly(addends.squares, min(s.value * s.value, vec3(3e38)));
    add_bias(addends, s);
}

void add_to_film(uint place, FilmAddends addends) {
    ADD_DIGITS(film[place].sum, addends.sum)
    ADD_DIGITS(film[place].squares, addends.squares)
    ADD_BIAS(place, addends)
}
