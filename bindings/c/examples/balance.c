/* A policy balances a pole: balance [MODEL] */
#include <opendr.h>
#include <stdio.h>

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, opendr_last_error());
    return 1;
}

int main(int argc, char **argv) {
    opendr_env *cart = NULL;
    opendr_learner *policy = NULL;
    opendr_observation *seen = NULL;
    opendr_env_step_result step = {0};
    const uint64_t seed = 7;
    double earned = 0;
    if (opendr_env_make("CartPole-v1", NULL, &cart)) return failed("CartPole-v1");
    if (opendr_load_ppo(argc > 1 ? argv[1] : NULL, NULL, NULL, &policy)) return opendr_env_close(&cart), failed("ppo");
    if (opendr_env_reset(cart, &seed, &seen)) failed("reset");
    while (seen != NULL && !step.terminated && !step.truncated) {
        opendr_rl_target *chosen = NULL;
        const float *action;
        size_t count;
        if (opendr_infer_ppo(policy, seen, &chosen) || opendr_rl_target_read(chosen, &action, &count)) break;
        opendr_observation_free(&seen);
        if (opendr_env_step(cart, action, count, &step, &seen)) failed("step");
        opendr_rl_target_free(&chosen);
        earned += step.reward;
    }
    printf("return %.0f\n", earned);
    opendr_observation_free(&seen);
    opendr_learner_free(&policy);
    opendr_env_close(&cart);
    return earned >= 475 ? 0 : 1;
}
