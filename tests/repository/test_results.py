"""The numbers on pages of results match the tables next to them, and the scoreboard matches the tool's verdicts."""

import json
import re
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from result_page import p_of, p_text, page, small, span, table, text
from resumed_run import WINDOW as WINDOW_STEPS
from resumed_run import small_run
from scipy import stats

from hedon.record.reader import open_run
from hedon.statistic import holm
from hedon.statistic.extinction import extinct_share
from hedon_studies.fear.program import PITFALL_COLUMNS, PITFALL_RUN, PREDATOR_RUN, WINDOW

FOUNDERS = {"predator": ("w_normal", "w_action", "w_see_prey", "w_see_predator")}
FOUNDERS["pitfall"] = ("w_normal", "w_action", "w_see_agent", "w_see_obstacle")
SURVIVAL_STEPS = 256_000
PAPER_STEPS = 10_240_000
HUNTED = ("predator", "predator-small-mouth", "predator-large-mouth", "predator-less-food")


def test_evolution_from_above():
    """Decreases from the starting weights, and paired differences from the control that starts at 0, by Student's t."""
    text_of, worlds = page("start.md"), table("start/from/worlds.csv").sort("start", "seed")
    assert table("start/rate/worlds.csv")["seed"].unique().sort().equals(worlds["seed"].unique().sort())
    for (start, step), rows in worlds.group_by("start", "step"):
        food = rows.sort("seed")["w_normal"].to_numpy()
        by_seed = ", ".join(text(value, 1) for value in food)
        if start == 5 or step in (512_000, 1_024_000):
            assert f"| {by_seed} | {span(food, 2, sign=False)} |" in text_of, (start, step)
    last = worlds.filter(step=1_024_000)
    control = table("start/rate/worlds.csv").filter(learning_rate=0.0003, step=1_024_000).sort("seed")["w_normal"]
    tests = {f"from {start}, less {start}": last.filter(start=start)["w_normal"].to_numpy() - start for start in (5, 2)}
    tests["from 5 less the control, less 5"] = (last.filter(start=5)["w_normal"] - control).to_numpy() - 5
    corrected = dict(zip(tests, holm([p_of(values) for values in tests.values()]), strict=True))
    for name, values in tests.items():
        below, p_values = (values < 0).sum(), f"{small(p_of(values))} | {small(corrected[name])}"
        row = f"| {name} | {span(values, 2)} | {below} of 6 | {p_values} |"
        assert row in text_of, row
    held = table("start/from/together.csv").row(by_predicate=pl.col("weight") == "w_normal", named=True)
    optimum, low, high = (text(held[name], 2) for name in ("optimum", "optimum_low", "optimum_high"))
    assert held["worlds"] == 18
    assert f"held at {optimum} ({low} … {high}), p {p_text(held['p'])}" in text_of
    assert f"held at {optimum} ({low} to {high}, p {p_text(held['p'])}," in page("../paper/paper.md").replace("\n", " ")


def slopes(path: str, weights: tuple[str, ...], outcome: str) -> dict[int, np.ndarray]:
    """For each world, the slopes of relative fitness on the weights, by least squares on all of them."""
    found = {}
    for (seed,), rows in table(path).group_by("seed", maintain_order=True):
        fitness = rows[outcome].to_numpy()
        inputs = np.column_stack([np.ones(len(rows)), *(rows[weight].to_numpy() for weight in weights)])
        found[seed] = np.linalg.lstsq(inputs, fitness / fitness.mean(), rcond=None)[0][1:]
    return found


@pytest.mark.parametrize(
    ("outcome", "weight", "label"),
    [
        ("lifespan", 3, "lifespan: seeing predators, all ten"),
        ("descendants", 3, "living descendants: seeing predators, all ten"),
        ("offspring", 2, "children: seeing prey, all ten"),
        ("descendants", 2, "living descendants: seeing prey, all ten"),
        ("offspring", 3, "… **all ten**"),
    ],
)
def test_slopes_of_prey_by_group_of_founders(outcome, weight, label):
    weights = FOUNDERS["predator"]
    first = [slopes(f"predator/{name}/founders-outcome.csv", weights, outcome) for name in HUNTED]
    second = slopes("predator/predator-6-10/founders-outcome.csv", weights, outcome)
    alone = slopes("predator/prey-alone/founders-outcome.csv", weights, outcome)
    alone |= slopes("predator/prey-alone-6-10/founders-outcome.csv", weights, outcome)
    hunted = np.array(
        [np.mean([each[seed][weight] for each in first]) for seed in range(1, 6)]
        + [second[seed][weight] for seed in range(6, 11)]
    )
    without = np.array([alone[seed][weight] for seed in range(1, 11)])
    (row,) = [line for line in page("predator.md").splitlines() if line.startswith(f"| {label} ")]
    for values in (hunted, hunted - without):
        assert f"{span(values)}, p {p_of(values):.2f}" in row


def test_fear_by_the_sequels_senses():
    """Two specified tests over forty groups, each with and without predators, and what was seen afterwards."""
    weights, shown, named = FOUNDERS["predator"], " ".join(page("predator.md").split()), []
    for outcome, label in (("offspring", "children"), ("descendants", "living descendants")):
        by_world = [slopes(f"predator/fear/{name}.parquet", weights, outcome) for name in ("predator", "prey-alone")]
        assert [list(each) for each in by_world] == [list(range(11, 51))] * 2
        with_them, without = (np.array(list(each.values())) for each in by_world)
        named.append((label, with_them[:, 3], without[:, 3]))
        row = " | ".join(span(each[:, 2]) for each in (with_them, without, with_them - without))
        assert f"| {label}: seeing prey | {row} | not named |" in shown
    differences = [one - other for _, one, other in named]
    p = [p_of(each) for each in differences]
    for (label, one, other), difference, own, corrected in zip(named, differences, p, holm(p), strict=True):
        row = f"| **{label}**: seeing predators | {span(one)} | {span(other)} | **{span(difference)}** |"
        assert f"{row} {p_text(own)}, **{p_text(corrected)}** |" in shown
        told = f"({'difference in slope ' if label == 'children' else ''}{span(difference)[:-1].replace(' (', ', ')})"
        assert told in page("../paper/paper.md").replace("\n", " ")
    founders = table("predator/fear/predator.parquet")
    relative = [pl.col(name) / pl.col(name).mean().over("seed") for name in ("offspring", "descendants")]
    quarter = pl.col("w_see_predator").floor().clip(-2, 1).alias("quarter")
    means = founders.select(quarter, *relative).group_by("quarter").mean().sort("quarter")
    low, below, above, high = (" and ".join(f"{100 * each:.0f}" for each in row[1:]) for row in means.rows())
    children, descendants = high.split(" and ")
    assert f"above 1 have {children} % of the mean number of children and {descendants} % of its living" in shown
    assert (
        f"from 0 to 1 they have {above} %, from \N{MINUS SIGN}1 to 0 {below} %, below \N{MINUS SIGN}1 {low} %" in shown
    )
    alone = founders.select("seed", "w_see_predator", relative[1])
    for half, label in (
        (pl.col("w_see_predator") >= 0, "above 0: descendants"),
        (pl.col("w_see_predator") < 0, "below 0:"),
    ):
        groups = [rows for _, rows in alone.filter(half).group_by("seed", maintain_order=True)]
        within = np.array([np.polyfit(rows["w_see_predator"], rows["descendants"], 1)[0] for rows in groups])
        assert f"{label} {span(within)[:-1].replace(' (', ', ')}" in shown


@pytest.mark.parametrize("outcome", ["offspring", "lifespan", "food", "descendants"])
def test_slopes_with_seeing_obstacles(outcome):
    label = {"offspring": "children", "descendants": "living descendants"}.get(outcome, outcome)

    def by_group(*names: str) -> np.ndarray:
        found = [slopes(f"pitfall/{name}/founders-outcome.csv", FOUNDERS["pitfall"], outcome) for name in names]
        return np.array([np.mean([each[seed][3] for each in found]) for seed in range(1, 6)])

    right, wrong = by_group("pitfall", "pitfall-weak"), by_group("pitfall-wrong", "pitfall-weak-wrong")
    (row,) = [line for line in page("pitfall.md").splitlines() if line.startswith(f"| {label} |")]
    for values in (right, wrong, right - wrong):
        assert f"{span(values)}, p {p_text(p_of(values))}" in row


def test_founders_by_their_gene_of_the_learning_rate():
    founders = table("inner/learning-rate-16/tables/founder.parquet")
    relative = [(pl.col(name) / pl.col(name).mean().over("seed")).alias(name) for name in ("descendants", "food")]
    founders = founders.with_columns(relative)
    for low, high in ((-2, -1), (-1, 0), (0, 0.4), (0.4, 1.5), (1.5, 2)):
        here = founders.filter(pl.col("g_learning_rate").is_between(low, high, closed="left"))
        means = " | ".join(text(here[name].to_numpy().mean(), 2) for name in ("descendants", "food"))
        ends = [text(end, 0 if end == int(end) else 1) for end in (low, high)]
        assert f"| {ends[0]} to {ends[1]} | {len(here)} | {means} |" in page("inner.md")


def test_pairs_with_the_gene_of_the_learning_rate_and_without():
    worlds, shown = table("inner/pairs/worlds.csv"), " ".join(page("inner.md").split())
    gene, control = (worlds.filter(condition=arm).sort("seed") for arm in ("gene", "control"))
    assert gene["seed"].equals(control["seed"])
    food = 1000 * (gene["food_per_agent_step"] - control["food_per_agent_step"]).to_numpy()
    assert (
        f"{span(food)} foods per 1,000 agent-steps, in {(food > 0).sum()} of ten; p {p_text(p_of(food))} by t" in shown
    )
    more = food.mean() / (1000 * control["food_per_agent_step"].to_numpy().mean())
    assert f"1.1e-3, so {100 * more:.1f} % more" in shown
    end = gene["g_learning_rate"].to_numpy()
    assert f"{span(end, 2)}, above 0 in {(end > 0).sum()} of ten, p {p_text(p_of(end))}" in shown
    for column, digits, label in (("alive", 1, "alive"), ("energy", 2, "energy"), ("w_normal", 2, "weight of food")):
        difference = (gene[column] - control[column]).to_numpy()
        assert f"{label} {span(difference, digits)}, p {p_text(p_of(difference))}" in shown


def test_ten_seeds_of_the_baseline():
    worlds, drift, shown = (
        table("acting/tables/acting_worlds.csv"),
        table("acting/tables/drift.csv"),
        page("baseline.md"),
    )
    for gene, label in (("w_food", "weight of food, 5000 born last"), ("w_action", "weight of action")):
        by_arm = [worlds.filter(condition=arm)[gene].to_numpy() for arm in ("bfloat16", "float32")]
        (row,) = [line for line in shown.splitlines() if line.startswith(f"| {label} | {text(by_arm[0].mean(), 2)}")]
        assert row.endswith(" | ".join(span(values, 2, sign=False) for values in by_arm) + " |")
    scores = drift.filter((pl.col("weight") == "w_normal") & (pl.col("test") == "direction"))
    for row in scores.to_dicts():
        reach = stats.norm.ppf(0.975) / row["worlds"] ** 0.5  # as for p: scores of drift are standard normal
        bounds = f"({text(row['effect'] - reach, 2)} … {text(row['effect'] + reach, 2)})"
        assert f"{text(row['effect'], 2)} {bounds}, p {p_text(row['p_holm'])}" in shown


def test_the_baseline_at_full_length():
    shown = page("baseline.md")
    for gene, label in (("w_normal", "weight of food, 5000 born last"), ("w_action", "weight of action")):
        means = table("full/tables/drift_world.csv").filter(weight=gene)["mean"].to_list()
        assert f"| {label} | {text(means[0], 2)} | {text(means[1], 2)} |" in shown


def test_slopes_of_the_near_landscape():
    surface, shown = table("landscape/near/tables/surface.csv"), page("landscape.md")
    for quantity, label in (("slope at 0", "slope"), ("curvature", "curvature")):
        (row,) = [line for line in shown.splitlines() if line.startswith(f"| {label} of living descendants |")]
        mine = surface.filter(fitness="descendants", quantity=f"{quantity}, quadratic")
        for found in mine.to_dicts():
            assert f"({text(found['low'], 2)} … {text(found['high'], 2)})" in row


def test_extinct_worlds_of_the_map_of_costs():
    worlds = table("cost/worlds.csv")
    gone = worlds.filter(pl.col("extinct")).row(0, named=True)
    assert worlds["extinct"].sum() == 1
    assert len(worlds) == 100
    assert f"one (0.03 … 5.4 %): seed {gone['seed']} at step {gone['extinct_step']:,}" in page("cost.md")


def test_how_much_of_a_replayed_world_is_settled():
    shown, rows = page("contingency.md"), table("contingency/apart.csv")
    titles = {"neutral genes": "neutral genes", "w_normal_mean": "weight of food", "w_action_mean": "weight of action"}
    for measure, title in (titles | {"alive_mean": "agents alive"}).items():
        cells = []
        for row in rows.filter(measure=measure).sort("step").to_dicts():
            told = f"{row['ratio']:.2f} ({row['low']:.2f} … {row['high']:.2f})"
            cells.append(f"**{told}**" if row["result"] == "partly settled" else told)
        assert f"| {title} | {' | '.join(cells)} |" in shown
    worlds = table("contingency/worlds.csv")
    fresh = worlds.filter(past="fresh")
    assert (worlds["w_normal_mean"] > 0).all()
    assert f"{fresh['w_normal_mean'].min():.2f} to {fresh['w_normal_mean'].max():.2f}" in shown
    spread = {
        name: np.std(fresh[name].to_numpy(), ddof=1) for name in worlds.columns if name.startswith(("w_", "neutral"))
    }
    neutral = np.mean([value for name, value in spread.items() if name.startswith("neutral")])
    told = f"is {spread['w_normal_mean']:.2f} for food, {neutral:.2f} for the average neutral gene"
    assert f"{told}, and {spread['w_action_mean']:.2f} for action" in " ".join(shown.split())
    lines = table("contingency/overlap.csv")
    assert (lines["p"] < 0.00805).all()
    assert f"{lines['descendants in all'].sum()} of the {lines['agents then'].sum():,}" in shown


def test_the_papers_program_over_its_five_worlds():
    summary, shown = json.loads(page("program/baseline/summary.json")), page("released.md")
    lifetime = summary["mean_lifetime"]
    assert f"{lifetime['mean']:,.0f} ({lifetime['low']:,.0f} … {lifetime['high']:,.0f}) steps" in shown
    assert [world["seed"] for world in summary["worlds"]] == [1, 2, 3, 4, 5]
    part = shown[shown.index("## What it does: the baseline") : shown.index("## At the paper's own length")]
    rows = {line.split(" ")[1]: line for line in part.splitlines() if re.match(r"\| [1-5] \|", line)}
    for world in summary["worlds"]:
        means = {name: found["mean"] for name, found in world["weights"].items()}
        spread = np.sqrt(np.mean([mean**2 for name, mean in means.items() if name.startswith("neutral")]))
        told = f"| {text(means['w_normal'], 2)} | {text(means['w_action'], 2)} | {spread:.1f} |"
        assert told in rows[str(world["seed"])]


@pytest.mark.parametrize("seed", [1, 2, 4])
def test_lines_that_only_mutate(seed):
    """The table of each seed's drift is what the example computes from the seed alone."""
    first = table("program/mutation-lines.csv").filter(seed=seed).row(0, named=True)
    assert next(example()["lines"]([seed])) == first


def example() -> dict[str, Any]:
    return runpy.run_path(str(Path(__file__).parents[2] / "examples" / "mutation_lines.py"))


def test_births_have_the_mutations_that_the_example_draws(tmp_path):
    """A child's genes are its parent's plus an entry of the seed's table, unless it dies as a newborn."""
    kept = ("world.mutation_noise=tabulated", "world.inheritance=at_window_end")
    small_run(tmp_path / "run", 12 * WINDOW_STEPS, seeds=(3,), overrides=kept)
    run, draw, seen = open_run(tmp_path / "run"), example()["birth_table"], 0
    window = (pl.col("birth_step") - 1) // WINDOW_STEPS
    whole = pl.col("death_step").is_null() | (pl.col("death_step") > (window + 1) * WINDOW_STEPS)
    agents = run.agents().sort("agent_id").with_columns(window=window, has_own=whole | (pl.col("birth_step") == 0))
    own = {each["agent_id"]: each for each in agents.iter_rows(named=True)}
    for (_,), born in agents.filter(pl.col("birth_step") > 0).group_by("window", maintain_order=True):
        first = len(born) * (len(born) - 1) // 2  # entries of windows with fewer births come before
        for place, gene in enumerate(run.weight_names):
            entry = draw(3, place, 0.02)[0][first : first + len(born)]
            for child, mutation in zip(born.iter_rows(named=True), entry, strict=True):
                parent = own[child["parent_id"]]
                if child["has_own"] and parent["has_own"]:
                    assert child[gene] == pytest.approx(np.clip(parent[gene] + mutation, -10, 10), abs=2e-5)
                    seen += 1
    assert seen > 300


def test_the_papers_program_at_its_own_length():
    """Rows of the page from its tables, and how many genes end on the same side as lines that only mutate."""
    genes, course, shown = table("program/full/genes.csv"), table("program/full/course.csv"), page("released.md")
    lines = table("program/mutation-lines.csv")
    assert genes.select(lines.columns).equals(lines.filter(pl.col("seed").is_in([1, 2, 4])))
    assert course["step"].max() == PAPER_STEPS
    neutral = genes.filter(pl.col("gene").str.starts_with("neutral"))
    assert f"and {neutral['as_lines'].sum()} of 48 neutral genes are on their lines' side" in shown
    assert f"correlate at {np.corrcoef(neutral['median'], neutral['end'])[0, 1]:.2f}" in shown
    for (seed,), mine in genes.group_by("seed"):
        stretches = course.filter(pl.col("seed") == seed)
        last = stretches.filter(pl.col("step") > 0.8 * PAPER_STEPS)
        own = mine.filter(pl.col("gene").str.starts_with("neutral"))
        weights = [f"{text(row['end'], 1)} ({text(row['median'], 1)})" for row in mine.head(2).iter_rows(named=True)]
        told = [
            str(seed),
            text(last["alive"].to_numpy().mean(), 0),
            text(1000 * last["food_per_agent_step"].to_numpy().mean(), 2),
            f"{last['steps_per_death'].to_numpy().mean():,.0f}",
            *weights,
            f"{own['as_lines'].sum()} of 16",
            f"{np.sqrt(np.mean(own['end'].to_numpy() ** 2)):.1f}",
            f"{stretches['generation'].to_list()[-1]:,.0f}",
        ]
        assert f"| {' | '.join(told)} |" in shown
        tenths = stretches.filter(pl.col("step") % 1_024_000 == 0).select("w_normal", "w_action")
        assert f"| {seed} | " + " | ".join(f"{text(a, 1)}, {text(b, 1)}" for a, b in tenths.iter_rows()) + " |" in shown


def window_rows(name: str) -> list[str]:
    """The rows that compare first windows with those of the sequel's program."""
    rows = table(f"{name}/first-windows.csv")
    if name == "predator":
        prey, predators = rows.filter(species="prey"), rows.filter(species="predator")
        columns = [("births", prey), ("deaths_eaten", prey), ("food_normal", prey), ("energy_mean", prey)]
        alive, run = [("alive", prey), ("alive", predators)], PREDATOR_RUN
    else:
        rows = rows.filter(sight="released")
        columns = [(column, rows) for column in PITFALL_COLUMNS[1:]]
        alive, run = [("alive", rows)], PITFALL_RUN

    def range_of(column: str, mine: pl.DataFrame, number: int) -> str:
        values = mine.filter(step=number * WINDOW)[column].to_list()
        digits = 1 if column == "energy_mean" else 0
        shown = [f"{value:.{digits}f}" for value in (min(values), sum(values) / len(values), max(values))]
        return "\N{EN DASH}".join(dict.fromkeys(shown))

    made = []
    for number, told in run.items():
        theirs = [", ".join(map(str, told[: len(alive)])), *map(str, told[len(alive) :])]
        ours = [", ".join(range_of(*each, number) for each in alive), *(range_of(*each, number) for each in columns)]
        made.append("| " + " | ".join([str(number), *theirs, *ours]) + " |")
    return made


@pytest.mark.parametrize("name", ["predator", "pitfall"])
def test_first_windows_beside_the_sequels_program(name):
    rows = window_rows(name)
    assert len(rows) >= 5
    for row in rows:
        assert row in page(f"{name}.md")


def test_worlds_that_keep_their_predators():
    rows, shown = table("predator/survival/tables/sequel_alive.csv"), " ".join(page("predator.md").split())
    prey, predators = rows.filter(species="prey"), rows.filter(species="predator")
    ends = predators["died_out"].drop_nulls().to_list()
    assert prey["died_out"].null_count() == len(prey) == 20
    assert f"at step {ends[0]:,}; none loses its prey" in shown
    share = extinct_share(
        predators.select(pl.coalesce("died_out", "last_step")).to_series().to_numpy().astype(float),
        predators["died_out"].is_not_null().to_numpy(),
        SURVIVAL_STEPS,
    )
    kept = [100 * (1 - each) for each in (share.share, share.high, share.low)]
    assert f"{kept[0]:.0f} % ({kept[1]:.0f} … {kept[2]:.0f} %, Kaplan" in shown
    p = stats.fisher_exact([[len(ends), len(predators) - len(ends)], [1, 5]])[1]
    assert f"Fisher's exact test sees no difference (p {p:.2f})" in shown
    both = predators.filter(pl.col("died_out").is_null())["seed"]
    kept_alive = [group.filter(pl.col("seed").is_in(both.to_list()))["alive"].to_numpy() for group in (prey, predators)]
    for alive in kept_alive:
        assert f"{alive.min():.0f} to {alive.max():.0f}, mean {alive.mean():.0f}" in shown
    assert f"above in {(kept_alive[0] > 349).sum()} of {len(both)}" in shown
    article = " ".join(page("../paper/paper.md").split())
    assert f"{len(both)} of our {len(prey)} worlds keep both species" in article
    assert f"with {kept_alive[1].mean():.0f} predators on average" in article
    assert f"; in {((kept_alive[1] >= 10) & (kept_alive[1] <= 30)).sum()} of {len(both)}" in shown
    judged = table("predator/survival/tables/verdict.csv")
    assert (judged["verdict"] == "undecided").all()
    assert [round(value * len(both)) for value in judged["value"]] == [0, 1, 1]
    assert "97.5 % of neutral genes; in one world it is above, as is the weight of seeing prey." in shown


VERDICT = re.compile(
    r"\*?\*?(holds|fails|undecided)\*?\*? \((\d+) worlds?(?:, [^)]*)?\) \[[^]]*\]\((\S+?/tables/verdict\.csv)\)"
)


def test_the_scoreboard_prints_the_verdicts_of_the_tool():
    rows = [line.split("|")[1:-1] for line in page("README.md").splitlines() if "verdict.csv" in line]
    judged = 0
    for claim, told, *_ in rows:
        names = re.findall(r"`([^`]+)`", claim)
        assert len(names) == 1, claim
        for verdict, worlds, path in VERDICT.findall(told):
            found = table(path).filter(claim=names[0])
            match = found.filter((pl.col("verdict") == verdict) & (pl.col("worlds") == int(worlds)))
            assert len(match), (names[0], verdict, worlds, path)
            judged += 1
    assert judged == sum(line.count("verdict.csv)") for line in page("README.md").splitlines() if "|" in line)
    assert judged >= 12


def test_no_word_of_the_tool_is_used_for_an_opinion():
    """What we think is in a separate column, in words other than those of the verdicts."""
    header, *rows = [line for line in page("README.md").splitlines() if line.startswith("|")]
    assert "what we think so far" in header
    opinions = [line.split("|")[-2] for line in rows[1:]]
    assert len(opinions) >= 10
    assert not [each for each in opinions if re.search(r"\b(holds|fails|undecided)\b", each)]
