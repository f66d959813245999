/* Runs a policy in CartPole: balance [MODEL] */
#include <opendr.h>
#include <stdio.h>

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, opendr_last_error());
    return 1;
}

int main(int argc, char **argv) {
    opendr_env *cart = NULL;
    opendr_learner *policy = NULL;
    opendr_observation *observation = NULL;
    opendr_env_step_result step = {0};
    const uint64_t seed = 7;
    double episode_return = 0;
    if (opendr_env_make("CartPole-v1", NULL, &cart)) return failed("CartPole-v1");
    if (opendr_load_ppo(argc > 1 ? argv[1] : NULL, NULL, NULL, &policy)) return opendr_env_close(&cart), failed("ppo");
    if (opendr_env_reset(cart, &seed, &observation)) failed("reset");
    while (observation != NULL && !step.terminated && !step.truncated) {
        opendr_rl_target *target = NULL;
        const float *action;
        size_t count;
        if (opendr_infer_ppo(policy, observation, &target) || opendr_rl_target_read(target, &action, &count)) break;
        opendr_observation_free(&observation);
        if (opendr_env_step(cart, action, count, &step, &observation)) failed("step");
        opendr_rl_target_free(&target);
        episode_return += step.reward;
    }
    printf("return %.0f\n", episode_return);
    opendr_observation_free(&observation);
    opendr_learner_free(&policy);
    opendr_env_close(&cart);
    return episode_return >= 475 ? 0 : 1;
}
