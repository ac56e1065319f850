from hedon_studies.kanagawa_doya_2024.paper import EXTINCTION, PAPER, paper_figures


def test_the_papers_numbers_are_in_proportion() -> None:
    assert set(PAPER) == {"baseline", "small", "large", "centered", "relocation", "poor", "poison"}
    assert paper_figures(None) is None
    assert paper_figures("my-own") is None
    for figures in PAPER.values():
        if figures.food_per_step is not None and figures.mean_lifetime is not None:
            assert 1 < figures.food_per_step * figures.mean_lifetime < 1000  # foods per life
    assert all(0 <= share <= 1 for share in EXTINCTION.values())
