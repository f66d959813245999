/*
 * What a learner answers, for the tests that compare surfaces: runner LEARNER[/VARIANT] PARAMS_JSON INPUT [PORT=JSON_FILE ...]
 *
 * For each picture of INPUT a line with the JSON of the outputs by name, as `opendr infer --json` has it under "outputs".
 * OPENDR_RUNNER_MODEL names a model container; without it the pretrained model is taken. An init input is given with
 * the first picture only; every picture is a stream of its own unless OPENDR_RUNNER_SEQUENCE is set.
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

static char *read_file(const char *path) {
    FILE *file = fopen(path, "rb");
    size_t size = 0, read = 0;
    char *text = NULL;
    if (file == NULL) return perror(path), exit(1), NULL;
    do {
        size += read;
        text = (char *)realloc(text, size + 65537);
    } while ((read = fread(text + size, 1, 65536, file)) > 0);
    text[size] = '\0';
    fclose(file);
    return text;
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

int main(int argc, char **argv) {
    opendr_learner *learner = NULL;
    opendr_source *source = NULL;
    opendr_image *image = NULL;
    opendr_input inputs[MOST];
    opendr_output outputs[MOST];
    size_t input_count = 1, output_count = 0;
    if (argc < 4 || argc - 3 > MOST) return fprintf(stderr, "usage: runner LEARNER PARAMS_JSON INPUT [PORT=FILE ...]\n"), 2;
    check(opendr_load(argv[1], getenv("OPENDR_RUNNER_MODEL"), NULL, argv[2], &learner));
    check(opendr_source_open(argv[3], &source));
    for (int i = 4; i < argc; i++, input_count++) {
        char *file = strchr(argv[i], '=');
        char *json = NULL;
        opendr_value *value = NULL;
        if (file == NULL) return fprintf(stderr, "%s is no PORT=FILE\n", argv[i]), 2;
        *file = '\0';
        json = read_file(file + 1);
        check(opendr_value_from_json(NULL, json, &value));
        free(json);
        inputs[input_count].name = argv[i];
        inputs[input_count].value = value;
    }
    for (; output_count < MOST && opendr_output_name(learner, output_count) != NULL; output_count++)
        outputs[output_count].name = opendr_output_name(learner, output_count);
    qsort(outputs, output_count, sizeof outputs[0], by_name);
    inputs[0].name = opendr_input_name(learner, 0);
    for (check(opendr_source_next(source, &image)); image != NULL; check(opendr_source_next(source, &image))) {
        inputs[0].value = (const opendr_value *)image;
        check(opendr_infer(learner, inputs, input_count, outputs, output_count));
        print(outputs, output_count);
        check(opendr_image_free(&image));
        if (getenv("OPENDR_RUNNER_SEQUENCE") == NULL) check(opendr_reset(learner));
    }
    for (size_t i = 1; i < input_count; i++) {
        opendr_value *value = (opendr_value *)inputs[i].value;
        check(opendr_value_free(&value));
    }
    check(opendr_source_free(&source));
    return opendr_learner_free(&learner);
}
