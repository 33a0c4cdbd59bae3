#!/usr/bin/env perl
# SPDX-License-Identifier: LGPL-2.1-or-later
# Usage: bad_input.pl TABLE COMMAND...      in an empty current folder; COMMAND is billet, or mpirun ... billet
#
# Each line of TABLE is a scene that billet must refuse:    EDIT -> MESSAGE
# EDIT of block.prm, or of the file that a line 'scene FILE' names: see edit_scene.pl. MESSAGE: all that is printed, where '...' stands for anything, '@' for the file
# and the line of the last edit, '@{name}' for those of that subsection. 'allowed ...' alone stands for
# "@: 'Key' in 'Path': found 'value', allowed ...". After NAME := EDIT, NAME at the start of a line stands for EDIT.
# '#' begins a comment.
#
# One start of the program with --check reads the whole table: it must say the messages and nothing else. Every tenth
# scene (fiftieth under mpirun), and every one of a table run_*.cases (of what --check may pass), is also run. Each must
# end with exit code 2 and leave every file as it was, results of a run before included.
use strict;
use warnings;
use File::Basename;

my $here = dirname(__FILE__);
require "$here/edit_scene.pl";

my ($table, @command) = @ARGV;
my $runs_all = basename($table) =~ /^run_/;

enter_folder();
mkdir 'no_history' and mkdir 'no_history/history.csv'; # a folder where a file should be
my $base_name = read_text($table) =~ /^scene (\S+)$/m ? $1 : 'block.prm';
my $base = read_text("$here/$base_name");
write_text('scene.prm', $base);
my ($code, undef, $errors) = run($command[-1], 'scene.prm');
die "$base_name itself fails ($code): $errors\n" if $code;

# --- the table -----------------------------------------------------------------------------------------------------

my (@cases, %short); # of each case: its name, its file, the message and its pattern
for (split /\n/, read_text($table))
{
  next if /^\s*(#|$)|^scene \S+$/;
  if (/^(\w+) := (.*)/)
  {
    $short{$1} = $2;
    next;
  }
  my ($edits, $expected) = /^(.*?)\s*-> (.*)$/ or die "$table: no '->' in: $_\n";
  my $name = $edits;
  $edits =~ s/^(\w+)(?= &|$)/$short{$1} \/\/ $1/e;
  my ($scene, $line, $path, $key, $value) = edit($base, $edits);
  my $file = sprintf 'case_%03d.prm', 1 + @cases;
  write_text($file, $scene);

  $expected = "\@: '$key'" . ($path && " in '$path'") . ": found '$value', $expected" if $expected =~ /^allowed /;
  $expected =~ s/\@\{(.*?)\}/"$file:" . line_of($scene, $1)/ge;
  $expected =~ s/\@/$file:$line/g;
  $expected =~ s/\bscene\.prm\b(?=:)/$file/g;
  my $pattern = join '.*', map { quotemeta } split /\.\.\./, $expected, -1;
  push @cases, { name => $name, file => $file, expected => $expected, pattern => qr/^error\[bad-input\]: $pattern\.?\n\z/ };
}

# --- the program ---------------------------------------------------------------------------------------------------

my %faults;
my $before = picture();

# Runs the cases at once and notes their faults.
sub refused
{
  my ($option, @these) = @_;
  my ($code, $output, $errors) = run(@command, @$option, map { $_->{file} } @these);
  my @messages = split /^(?=error\[)/m, $errors;
  for my $case (@these)
  {
    my $is_of_another = @messages && $messages[0] =~ /^error\[bad-input\]: (case_\d+\.prm)/ && $1 ne $case->{file};
    my $message = @messages && !$is_of_another ? shift @messages : "nothing\n";
    $faults{$case->{name}} .= "says:\n${message}instead of:\nerror[bad-input]: $case->{expected}\n" if $message !~ $case->{pattern};
  }
  my $last = $these[-1]{name};
  $faults{$last} .= "prints:\n" . join '', (split /^/m, $output)[0 .. 7] if $output ne '';
  $faults{$last} .= "says besides:\n@messages" if @messages;
  $faults{$last} .= $code == 124 || $code == 137 ? "hangs\n" : "exit code $code\n" if $code != 2;
  my $after = picture();
  my @changed = differences($before, $after);
  $faults{$last} .= 'writes over ' . @changed . " files, such as $changed[0]\n" if @changed;
  $before = $after;
}

refused(['--check'], @cases) unless $runs_all;
refused([], $_) for @cases[grep { $runs_all || $_ % (@command == 1 ? 10 : 50) == 0 } 0 .. $#cases];

print "$_->{name}: ", (exists $faults{$_->{name}} ? "FAILED: $faults{$_->{name}}" : "ok\n") for @cases;
printf "%d cases, %d failed\n", scalar @cases, scalar keys %faults;
exit(@cases && !%faults ? 0 : 1);
