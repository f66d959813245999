/*
 * Prints the predictions of a learner, for the tests that compare the interfaces; the counterpart of
 * crates/opendr/examples/infer_json.rs:
 * runner LEARNER[=CONTAINER] PARAMS_JSON PORT=FILE PORT=FILE ... , PORT=FILE ...
 *
 * Commas separate the calls of one stream. Each call prints one line with the JSON of its outputs by name.
 *
 * runner --fit LEARNER DATASET OPTIONS_JSON prints the report of a training, and the number of progress events on standard error.
 */
#include <opendr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 16

static void check(opendr_status status) {
    if (status == OPENDR_OK) return;
    fprintf(stderr, "%s: %s\n", opendr_status_name(status), opendr_last_error());
    exit(status);
}

static int by_name(const void *left, const void *right) {
    return strcmp(((const opendr_output *)left)->name, ((const opendr_output *)right)->name);
}

static void print(opendr_output *outputs, size_t count) {
    printf("{");
    for (size_t i = 0; i < count; i++) {
        opendr_string *json = NULL;
        check(opendr_value_to_json(outputs[i].value, &json));
        printf("%s\"%s\":%s", i == 0 ? "" : ",", outputs[i].name, opendr_string_text(json));
        check(opendr_string_free(&json));
        check(opendr_value_free(&outputs[i].value));
    }
    printf("}\n");
}

/* Reads the input of an argument `PORT=FILE`. */
static opendr_input input(const opendr_learner *learner, char *word) {
    opendr_input input;
    opendr_value *value = NULL;
    size_t port = 0;
    char *file = strchr(word, '=');
    if (file == NULL) return fprintf(stderr, "%s is no PORT=FILE\n", word), exit(2), input;
    *file++ = '\0';
    while (opendr_input_name(learner, port) != NULL && strcmp(opendr_input_name(learner, port), word) != 0) port++;
    check(opendr_value_open(opendr_input_type(learner, port), file, &value));
    input.name = word;
    input.value = value;
    return input;
}

/* Progress callback: counts the calls and stops the training at the call number in STOP_AT. */
static bool on_progress(void *context, const char *what, uint64_t done, uint64_t total, const char *status) {
    const char *stop = getenv("STOP_AT");
    int *calls = (int *)context;
    *calls += 1;
    if (what == NULL || status == NULL || (done > 0 && total == 0)) exit(3);
    return stop == NULL || *calls < atoi(stop);
}

static int fit(char **words) {
    opendr_learner *learner = NULL;
    opendr_string *report = NULL;
    int calls = 0;
    check(opendr_create(words[0], "cpu", NULL, &learner));
    check(opendr_fit(learner, words[1], NULL, words[2], on_progress, &calls, &report));
    puts(opendr_string_text(report));
    fprintf(stderr, "%d\n", calls);
    check(opendr_string_free(&report));
    return opendr_learner_free(&learner);
}

int main(int argc, char **argv) {
    opendr_learner *learner = NULL;
    opendr_output outputs[MOST];
    size_t output_count = 0;
    char *container;
    if (argc < 4) return fprintf(stderr, "usage: runner LEARNER[=CONTAINER] PARAMS_JSON PORT=FILE ... [, PORT=FILE ...]\n"), 2;
    if (argc == 5 && strcmp(argv[1], "--fit") == 0) return fit(argv + 2);
    container = strchr(argv[1], '=');
    if (container != NULL) *container++ = '\0';
    check(opendr_load(argv[1], container, NULL, argv[2], &learner));
    for (; output_count < MOST && opendr_output_name(learner, output_count) != NULL; output_count++)
        outputs[output_count].name = opendr_output_name(learner, output_count);
    qsort(outputs, output_count, sizeof outputs[0], by_name);
    for (int word = 3; word < argc; word++) {
        opendr_input inputs[MOST];
        size_t input_count = 0;
        for (; word < argc && strcmp(argv[word], ",") != 0 && input_count < MOST; word++)
            inputs[input_count++] = input(learner, argv[word]);
        check(opendr_infer(learner, inputs, input_count, outputs, output_count));
        print(outputs, output_count);
        while (input_count > 0) {
            opendr_value *value = (opendr_value *)inputs[--input_count].value;
            check(opendr_value_free(&value));
        }
    }
    return opendr_learner_free(&learner);
}
